#pragma once

#include <optional>
#include <span>

#include "common/matching/log_evidence.hpp"
#include "common/matching/odometry_lateness.hpp"

namespace slammot::matching {

struct OdometryTiming {
  double late_s = 0.0;
  double sigma_s = 0.0;
};

/// Clocks that drift apart: lateness at one time, and its growth from then on.
struct OdometryDrift {
  double late_s = 0.0;
  double at_s = 0.0;
  double drift = 0.0;  ///< Seconds a second.
};

/// Lateness of odometry's stamps against those of the scans, to some milliseconds, near `around_s`:
/// pairs between which speed or turn rate change (TimingPairs) are registered and compared with
/// odometry at each delay, by least squares with a factor of the turns and one of the ways, robust.
/// None where the pairs do not determine it. A scan is stamped at its first beam: of a scanner that
/// sweeps, odometry seems late by half of the sweep. range_unit_m: of the pairs' ranges.
/// scan_times_s: of all scans. odometry: of the base, in order of time.
std::optional<OdometryTiming> odometry_timing(std::span<const ScanPair> pairs,
                                              const AssumedBeams& beams, double range_unit_m,
                                              std::span<const double> scan_times_s,
                                              std::span<const TimedPose> odometry, double around_s);

/// The same where lateness changes evenly over the drive, if that is certain: to five sigmas and
/// 0.02 s, and if it explains the pairs clearly better than one lateness does.
std::optional<OdometryDrift> odometry_drift(std::span<const ScanPair> pairs,
                                            const AssumedBeams& beams, double range_unit_m,
                                            std::span<const double> scan_times_s,
                                            std::span<const TimedPose> odometry, double around_s);

}  // namespace slammot::matching
