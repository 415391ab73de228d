#pragma once

#include <cstdint>
#include <optional>

#include "common/filters/gaussian.hpp"
#include "common/flow/tracked_objects.hpp"

namespace slammot::collision_warning {

/// A turn straightens out with this time constant: bends and lane changes end.
inline constexpr double kTurnS = 3.0;

/// Motion of an object along its course at a stamp.
struct CourseState {
  double course_rad = 0.0;  ///< Direction of the motion in odom.
  double speed_mps = 0.0;   ///< Not negative.
  double acceleration_mps2 = 0.0;
  double yaw_rate_radps = 0.0;
  Eigen::Matrix2d turn_covariance = Eigen::Matrix2d::Zero();  ///< (course [rad], yaw rate [rad/s]).
};

/// Estimates course, acceleration and turn of an object from the velocities that tracking
/// publishes: two Kalman filters, of (speed, acceleration) and of (course, yaw rate). Errors of
/// published velocities last for some tenths of a second, so that one scan counts for little. A
/// pedestrian has no steady turn: the course is that of the velocity, without a covariance.
class ObjectMotion {
 public:
  /// State at this stamp. After a gap of more than half a second the filters start again.
  CourseState update(std::int64_t stamp_ns, const flow::TrackedObject& object);

 private:
  void start(double speed_mps, double course_rad);
  void follow(double dt_s, double speed_mps, double course_rad);

  std::optional<std::int64_t> stamp_ns_;  ///< None before the first velocity.
  filters::Gaussian<2> along_{};          ///< (speed [m/s], acceleration [m/s^2]).
  filters::Gaussian<2> turn_{};           ///< (course without wrapping [rad], yaw rate [rad/s]).
};

}  // namespace slammot::collision_warning
