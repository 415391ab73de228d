#pragma once

#include "common/geometry/pose2.hpp"

namespace slammot::geometry {

/// Pose at this difference, as defined by difference().
Pose2 displaced(const Pose2& pose, const Eigen::Vector3d& by);

/// Largest displacement of a point 10 m away by a difference of poses [m]: combines position and
/// heading.
double as_seen_10_m_away(const Eigen::Vector3d& difference);

}  // namespace slammot::geometry
