#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace slammot::app {

/// How fast a recorded drive is played. Time is a parameter.
class Pace {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// "max", or times the recorded speed: "1", "0.5", "20". None for what is neither.
  static std::optional<Pace> parse(const std::string& text);

  /// As fast as those who work on it: then flow control decides.
  bool is_unlimited() const { return !speed_; }

  /// When what was recorded at the stamp is due. The first call begins the drive at `now`; a stamp that goes back, or
  /// leaps ahead by more than a minute, begins it anew.
  Time due(std::int64_t stamp_ns, Time now);

  /// Begins the drive anew with the next stamp.
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
