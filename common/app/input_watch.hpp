#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace slammot::app {

using SteadyTime = std::chrono::steady_clock::time_point;

/// Whether silence of a topic is a fault.
enum class Input {
  kSteady,      ///< Arrives with every scan; silence is reported.
  kOccasional,  ///< Arrives on events only.
};

/// Time of an input's last sample.
class InputWatch {
 public:
  InputWatch(std::string topic_name, Input kind, SteadyTime since)
      : topic_name_(std::move(topic_name)), kind_(kind), since_(since) {}

  void came(SteadyTime now) {
    last_ = now;
    ++count_;
  }

  /// True if silent for longer than `patience` since the last sample or, before the first, since
  /// the start.
  bool is_missing(SteadyTime now, std::chrono::nanoseconds patience) const;

  /// "no slammot/laser_scan for 2.1 s" or "no slammot/laser_scan yet".
  std::string complaint(SteadyTime now) const;

  /// Seconds since the last sample; negative if there was none.
  double silent_s(SteadyTime now) const;

  const std::string& topic_name() const { return topic_name_; }
  std::uint64_t count() const { return count_; }

 private:
  std::string topic_name_;
  Input kind_;
  SteadyTime since_;
  std::optional<SteadyTime> last_;
  std::uint64_t count_ = 0;
};

}  // namespace slammot::app
