#pragma once

#include <optional>
#include <span>

#include "common/geometry/pose2.hpp"

namespace slammot::matching {

/// Motion of a vehicle between two of its scans.
struct PairMotion {
  geometry::Pose2 by_odometry;  ///< Of the point that odometry speaks of.
  geometry::Pose2 by_scans;     ///< Of the laser.
};

/// Where odometry's pose lies relative to the laser's.
struct OdometryPoint {
  geometry::Pose2 odometry_from_laser;
  geometry::Pose2 sigma;  ///< One sigma of x, y [m], and of the heading [rad].
};

/// Hand-eye calibration in the plane (Tsai and Lenz 1989): motions A by odometry and B by the
/// laser, rigidly connected by X, fulfil A X = X B. Two equations a pair, linear in the position of
/// X and in the factor and direction of the way, by least squares with Huber weights. None where
/// the motions do not determine it: without turns, or too few.
std::optional<OdometryPoint> odometry_point(std::span<const PairMotion> motions);

}  // namespace slammot::matching
