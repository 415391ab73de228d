#pragma once

#include <cstdint>
#include <optional>

#include "common/filters/gaussian.hpp"
#include "common/geometry/pose2.hpp"

namespace slammot::collision_warning {

/// Motion of the vehicle at a stamp.
struct VehicleState {
  geometry::Pose2 odom_from_base;
  double speed_mps = 0.0;  ///< Forward; negative in reverse.
  double acceleration_mps2 = 0.0;
  double yaw_rate_radps = 0.0;
};

/// Estimates speed, acceleration and turn of the vehicle from the poses of consecutive scans: two
/// Kalman filters, of (distance travelled, speed, acceleration) and of (heading, yaw rate).
class VehicleMotion {
 public:
  /// State at this pose. Poses that are not newer than the last one change nothing but the pose;
  /// after a gap of more than a second the filters start again.
  VehicleState update(std::int64_t stamp_ns, const geometry::Pose2& odom_from_base);

 private:
  void start(std::int64_t stamp_ns, const geometry::Pose2& odom_from_base);
  void follow(double dt_s, const geometry::Pose2& odom_from_base);

  std::optional<std::int64_t> stamp_ns_;  ///< None before the first pose.
  geometry::Pose2 odom_from_base_;
  double travelled_m_ = 0.0;
  double turned_rad_ = 0.0;       ///< Heading without wrapping, since the start.
  filters::Gaussian<3> along_{};  ///< (distance [m], speed [m/s], acceleration [m/s^2]).
  filters::Gaussian<2> turn_{};   ///< (heading [rad], yaw rate [rad/s]).
};

}  // namespace slammot::collision_warning
