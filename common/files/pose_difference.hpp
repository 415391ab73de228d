#pragma once

#include <cmath>

#include "common/geometry/pose2.hpp"

namespace slammot::files {

inline double distance_m(const geometry::Pose2& a, const geometry::Pose2& b) {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
}

/// Whether they are farther apart than this, in position or heading.
inline bool differ(const geometry::Pose2& a, const geometry::Pose2& b, double metres,
                   double radians) {
  return distance_m(a, b) > metres ||
         std::abs(geometry::wrap_angle(a.heading_rad - b.heading_rad)) > radians;
}

}  // namespace slammot::files
