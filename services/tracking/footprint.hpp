#pragma once

#include <Eigen/Core>

#include "services/tracking/road_users.hpp"

namespace slammot::tracking {

/// Oriented rectangle that an object covers; its centre is kept by the kinematics.
struct Footprint {
  double heading_rad = 0.0;  ///< Of the length, in odom.
  Size length;
  Size width;
  const RoadUsers* road_users = &kRoadUsersAnywhere;  ///< Prior of the sizes; not owned.
};

/// Vector from the rectangle, grown by margin_m on each side, to the point; zero inside. All in
/// odom.
Eigen::Vector2d offset_from(const Footprint& footprint, const Eigen::Vector2d& centre_m,
                            double margin_m, const Eigen::Vector2d& point_m);

/// True if offset_from() is zero. Rejects distant points without trigonometry.
bool is_inside(const Footprint& footprint, const Eigen::Vector2d& centre_m, double margin_m,
               const Eigen::Vector2d& point_m);

}  // namespace slammot::tracking
