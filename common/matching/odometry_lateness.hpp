#pragma once

#include <cstddef>
#include <span>

#include "common/geometry/pose2.hpp"

namespace slammot::matching {

/// How the vehicle moved between two scans, by a match of the two.
struct ScanPairMotion {
  std::size_t first_scan = 0;   ///< Counted from 0.
  std::size_t second_scan = 0;
  double turn_rad = 0.0;
  double way_m = 0.0;           ///< Of the laser.
};

struct TimedPose {
  double time_s = 0.0;
  geometry::Pose2 pose;
};

/// By how much odometry's stamps lag behind those of the scans [s]: the delay at which turns and ways by odometry fit those by
/// pairs of scans best, if they fit clearly better than without; else 0. odometry: in the order of time, a pose for each scan;
/// way_scale: way by scans over way by odometry. Delays up to a second are looked for. Where the vehicle turns and drives evenly nothing tells.
double odometry_lateness_s(std::span<const ScanPairMotion> pairs, std::span<const TimedPose> odometry, double way_scale);

}  // namespace slammot::matching
