#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "common/files/carmen_log.hpp"

namespace slammot {

/// One event of a log, with how much of the log was read for it.
struct ReadEvent {
  files::LogEvent event;
  double fraction_read = 0.0;  ///< [0, 1]
};

/// Reads a log on a thread of its own, some events ahead of whoever takes them: unpacking, parsing
/// and simulating cost the stages no time. The order is the log's. Nobody else may touch the log
/// until this is gone.
class ReadAhead {
 public:
  explicit ReadAhead(files::CarmenLog& log);
  ~ReadAhead();
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  /// Waits for the next event; nullopt at the end of what can be read.
  std::optional<ReadEvent> next();

 private:
  using Batch = std::vector<ReadEvent>;

  void read(const std::stop_token& stop);
  Batch read_batch();

  files::CarmenLog& log_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<Batch> ready_;  ///< The last one is empty when the log has ended.
  Batch taken_;              ///< By next(), from taken_count_ on.
  std::size_t taken_count_ = 0;
  bool is_ended_ = false;
  std::jthread thread_;  ///< Last: it must end before the rest goes.
};

}  // namespace slammot
