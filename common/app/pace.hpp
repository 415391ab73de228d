#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace slammot::app {

/// Replay speed of a recorded drive. Time is a parameter.
class Pace {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr const char* kExpected = "max or a number from 0.01 to 1000";

  /// "max", or a multiple of the recorded speed: "1", "0.5", "20". None if the text is neither.
  static std::optional<Pace> parse(const std::string& text);

  /// Unlimited: flow control sets the speed.
  bool is_unlimited() const { return !speed_; }

  /// Time at which the record of this stamp is due. The first call starts the drive at `now`. A
  /// stamp that decreases, or increases by more than a minute, restarts it.
  Time due(std::int64_t stamp_ns, Time now);

  /// Restarts the drive with the next stamp.
  void restart() { start_.reset(); }

 private:
  explicit Pace(std::optional<double> speed) : speed_(speed) {}

  struct Start {
    std::int64_t stamp_ns;
    Time time;
  };
  std::optional<double> speed_;  ///< None: unlimited.
  std::optional<Start> start_;
  std::int64_t last_stamp_ns_ = 0;
};

}  // namespace slammot::app
