#pragma once

#include "common/geometry/pose2.hpp"

/// Errors of a pose as twists (x [m], y [m], heading [rad]): the true pose is exponential(twist) *
/// estimate, so that a twist is a motion of the frame named first (Barrau and Bonnabel 2015). Poses
/// that are chained without error have the same twist, however uncertain their common heading is.
namespace slammot::geometry {

/// Motion by a twist for unit time: along an arc. Inverse of logarithm().
Pose2 exponential(const Eigen::Vector3d& twist);

/// Twist that makes this motion in unit time; headings of less than half a turn.
Eigen::Vector3d logarithm(const Pose2& motion);

/// Twist in a of a twist in b: a_from_b * exponential(twist) = exponential(adjoint(a_from_b) *
/// twist) * a_from_b.
Matrix3 adjoint(const Pose2& a_from_b);

/// Derivative of the twist by the change of (x, y, heading) that it makes to a pose.
Matrix3 twist_by_change(const Pose2& pose);

/// Its inverse: derivative of (x, y, heading) of a pose by the twist.
Matrix3 change_by_twist(const Pose2& pose);

}  // namespace slammot::geometry
