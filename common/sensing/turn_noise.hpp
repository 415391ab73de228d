#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/geometry/pose2.hpp"

namespace slammot::sensing {

/// White noise of the wheels' turns, as scans show it. Noise is in the wheels' turn and, with the
/// other sign, in what scans say beyond it: the covariance of that with the change of the wheels'
/// turn from one step to the next is the noise's variance. Errors of the scans are not in the
/// wheels, and a vehicle's turns change little from one scan to the next, where scans come often.
class TurnNoise {
 public:
  /// One more scan. heading_rad: by the scan, as if nothing had predicted it. by_wheels_rad: turn
  /// since the scan before.
  void add(double heading_rad, double by_wheels_rad, double duration_s) {
    if (heading_rad_ && by_wheels_rad_) {
      const double by_scans_rad = geometry::wrap_angle(heading_rad - *heading_rad_);
      const double told = (by_wheels_rad - by_scans_rad) * (by_wheels_rad - *by_wheels_rad_);
      const double most = kOutlier * std::max(variance_, kUsual);
      steps_ = std::min(steps_ + 1.0, kMemory);
      variance_ += (std::clamp(told / duration_s, -most, most) - variance_) / steps_;
    }
    by_wheels_rad_ = heading_rad_ ? std::optional(by_wheels_rad) : std::nullopt;
    heading_rad_ = heading_rad;
  }

  /// A scan told nothing.
  void interrupt() {
    heading_rad_.reset();
    by_wheels_rad_.reset();
  }

  /// Of the turn in a step [rad^2].
  double variance_in(double duration_s) const {
    return steps_ < kFewest ? 0.0 : std::max(0.0, variance_) * duration_s;
  }

  /// Passes each value of the state to the visitor, in a fixed order: for a checkpoint.
  template <typename Visitor>
  void visit(Visitor visit) const {
    visit(variance_), visit(steps_), visit(heading_rad_), visit(by_wheels_rad_);
  }
  template <typename Visitor>
  void visit(Visitor visit) {
    visit(variance_), visit(steps_), visit(heading_rad_), visit(by_wheels_rad_);
  }

  /// Whether a state that was read can have been one.
  bool is_sound() const {
    return steps_ >= 0.0 && steps_ <= kMemory && std::abs(variance_) < kLargest &&
           std::isfinite(heading_rad_.value_or(0.0)) && std::isfinite(by_wheels_rad_.value_or(0.0));
  }

 private:
  static constexpr double kUsual = 4e-6;   // 2 mrad after a second
  static constexpr double kOutlier = 9.0;  // times the variance
  static constexpr double kMemory = 200.0;
  static constexpr double kFewest = 10.0;
  static constexpr double kLargest = 1e6;

  double variance_ = 0.0;  ///< [rad^2/s]
  double steps_ = 0.0;
  std::optional<double> heading_rad_;
  std::optional<double> by_wheels_rad_;
};

}  // namespace slammot::sensing
