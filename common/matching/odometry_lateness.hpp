#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "common/geometry/pose2.hpp"

namespace slammot::matching {

/// Motion of the vehicle between two scans, by matching them.
struct ScanPairMotion {
  std::size_t first_scan = 0;  ///< Counted from 0.
  std::size_t second_scan = 0;
  double turn_rad = 0.0;
  double way_m = 0.0;  ///< Way of the laser.
};

struct TimedPose {
  double time_s = 0.0;
  geometry::Pose2 pose;
};

struct MotionScale {
  double way = 1.0;
  double turn = 1.0;
};

/// Motion between two times, interpolated; none where odometry does not cover both. odometry: in
/// order of time.
std::optional<geometry::Pose2> motion_between(std::span<const TimedPose> odometry, double first_s,
                                              double second_s);

/// Lateness of odometry's stamps against those of the scans [s]: the delay at which turns and ways
/// by odometry best fit those by pairs of scans. 0 unless the fit is significantly better than
/// without delay, and turns better than no turns. scan_times_s: of all scans. odometry: in order of
/// time, from any source. measured: ways and turns by scans over those by odometry. The search
/// covers delays up to 1 s. The delay is not observable at constant speed and turn rate.
double odometry_lateness_s(std::span<const ScanPairMotion> pairs,
                           std::span<const double> scan_times_s,
                           std::span<const TimedPose> odometry, const MotionScale& measured);

}  // namespace slammot::matching
