#include "common/geometry/displacement.hpp"

#include <cmath>

namespace slammot::geometry {

Pose2 displaced(const Pose2& pose, const Eigen::Vector3d& by) {
  return {pose.x_m + by.x(), pose.y_m + by.y(), wrap_angle(pose.heading_rad + by.z())};
}

double as_seen_10_m_away(const Eigen::Vector3d& difference) {
  return difference.head<2>().norm() + 10.0 * std::abs(difference.z());
}

}  // namespace slammot::geometry
