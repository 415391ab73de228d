#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "common/files/carmen_log.hpp"

namespace slammot {

/// An event of a log and the share of the log read so far.
struct ReadEvent {
  files::LogEvent event;
  double fraction_read = 0.0;  ///< [0, 1]
};

/// Reads a log ahead in a separate thread, so that decompression, parsing and simulation cost the
/// stages no time. Keeps the log's order. Nothing else may use the log while this exists.
class ReadAhead {
 public:
  explicit ReadAhead(files::CarmenLog& log);
  ~ReadAhead();
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  /// Waits for the next event; nullopt at the end of the readable part.
  std::optional<ReadEvent> next();

 private:
  using Batch = std::vector<ReadEvent>;

  void read(const std::stop_token& stop);
  Batch read_batch();

  files::CarmenLog& log_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<Batch> ready_;  ///< An empty batch marks the end of the log.
  Batch taken_;              ///< Batch that next() reads, from taken_count_ on.
  std::size_t taken_count_ = 0;
  bool is_ended_ = false;
  std::jthread thread_;  ///< Last member: must end before the others are destroyed.
};

}  // namespace slammot
