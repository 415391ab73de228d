#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "common/mcap/message_cursor.hpp"

namespace slammot::recorder {

struct KeptSample {
  std::int64_t log_time_ns = 0;
  std::int64_t source_ns = 0;  ///< The writer's system clock.
  std::vector<std::uint8_t> cdr;
};

/// An instance of a topic: channel and bytes of its key.
using InstanceKey = std::pair<mcap::ChannelId, std::vector<std::uint8_t>>;

/// The key of a sample into the vector; false if it is no sample of the channel's type.
using KeyOf = std::function<bool(mcap::ChannelId, mcap::Bytes cdr, std::vector<std::uint8_t>&)>;

/// The last sample of each instance.
std::map<InstanceKey, KeptSample> last_samples(const mcap::File& file, mcap::Selection selection,
                                               const KeyOf& key_of);

/// Samples that the bus keeps for late joiners, such as those of the map, at any time of a
/// recording. A thread reads them once from the beginning, so that a seek reads no chunk again.
class KeptSamples {
 public:
  using Visitor = std::function<void(mcap::ChannelId, const KeptSample&)>;

  static constexpr std::size_t kMostBytes = 512'000'000;

  /// The file must outlive it; key_of is called by another thread. Samples beyond most_bytes are
  /// read at each seek.
  KeptSamples(const mcap::File& file, std::set<std::string> topics, KeyOf key_of,
              std::size_t most_bytes = kMostBytes);

  /// The last sample of each instance up to that log time. Waits until the thread has come so far.
  void visit(std::int64_t log_time_ns, const Visitor& visitor);

 private:
  void read(const std::stop_token& stop);

  const mcap::File& file_;
  std::set<std::string> topics_;
  KeyOf key_of_;
  std::size_t most_bytes_;
  std::mutex mutex_;
  std::condition_variable progress_;
  std::map<InstanceKey, std::vector<KeptSample>> samples_;  ///< By log time.
  std::int64_t complete_before_ns_ = std::numeric_limits<std::int64_t>::min();
  bool has_ended_ = false;
  std::jthread reader_;
};

}  // namespace slammot::recorder
