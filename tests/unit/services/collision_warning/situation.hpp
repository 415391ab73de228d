#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "services/collision_warning/collision_monitor.hpp"

namespace slammot::collision_warning {

/// Straight motion of one road user at constant velocity.
struct RoadUser {
  Eigen::Vector2d from_m;
  Eigen::Vector2d velocity_mps;
  double length_m = 4.4;
  double width_m = 1.8;
};

/// The vehicle drives along x from the origin; the other one is tracked without gaps, with errors
/// of 0.1 m and 0.2 m/s.
inline flow::TrackedObjects tracked_at(double after_s, double speed_mps, const RoadUser& other) {
  flow::TrackedObject object;
  object.track_id = {17};
  object.confirmed = true;
  object.existence = 0.99;
  object.position_in_odom_m = other.from_m + after_s * other.velocity_mps;
  object.velocity_in_odom_mps = other.velocity_mps;
  object.covariance.diagonal() << 0.01, 0.01, 0.04, 0.04;
  object.heading_in_odom_rad = std::atan2(other.velocity_mps.y(), other.velocity_mps.x());
  object.length_m = other.length_m;
  object.width_m = other.width_m;
  flow::TrackedObjects tracked;
  tracked.stamp_ns = 5'000'000'000 + static_cast<std::int64_t>(after_s * 1e9);
  tracked.map_id = {7};
  tracked.odom_id = {1};
  tracked.odom_from_base = {speed_mps * after_s, 0.0, 0.0};
  tracked.objects = {object};
  return tracked;
}

}  // namespace slammot::collision_warning
