#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "services/recorder/recording.hpp"

namespace slammot::recorder {

/// Samples that were taken from all topics at one time, put into the order in which they were
/// written. Looking at all topics at once every few milliseconds costs half of waking up for each
/// sample (tests/tools/recorder_cost.py). Its memory is kept.
class SampleBatch {
 public:
  void add(mcap::ChannelId channel, std::int64_t source_time_ns,
           std::span<const std::uint8_t> bytes) {
    samples_.push_back({channel, source_time_ns, bytes_.size(), bytes.size()});
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }

  /// Hands all over and is empty. A sample's log time is its source time where that lies between
  /// the last look and this one, as it does while the writer's clock is right; the nearer of the
  /// two otherwise.
  void move_to(Recording& recording, std::int64_t last_look_ns, std::int64_t this_look_ns) {
    const auto log_time_ns = [&](const Sample& sample) {
      return std::clamp(sample.source_time_ns, std::min(last_look_ns, this_look_ns), this_look_ns);
    };
    std::ranges::stable_sort(samples_, {}, log_time_ns);
    for (const Sample& sample : samples_)
      recording.add(sample.channel, log_time_ns(sample), sample.source_time_ns,
                    mcap::Bytes(bytes_).subspan(sample.begin, sample.size));
    samples_.clear();
    bytes_.clear();
  }

 private:
  struct Sample {
    mcap::ChannelId channel;
    std::int64_t source_time_ns;
    std::size_t begin;
    std::size_t size;
  };
  std::vector<Sample> samples_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace slammot::recorder
