#pragma once

#include "common/geometry/pose2.hpp"

namespace slammot::geometry {

/// The pose that differs from this one by so much, as difference() counts it.
Pose2 displaced(const Pose2& pose, const Eigen::Vector3d& by);

/// How far a difference of poses moves what lies 10 m away, at most: position and heading in one length [m].
double as_seen_10_m_away(const Eigen::Vector3d& difference);

}  // namespace slammot::geometry
