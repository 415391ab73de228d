#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

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

/// A log with pairs of scans between which speed or turn rate change (TimingPairs).
struct LogToTime {
  std::span<const ScanPair> pairs;
  AssumedBeams beams;
  double range_unit_m = 1.0;             ///< Of the pairs' ranges.
  std::span<const double> scan_times_s;  ///< Of all scans.
  std::span<const TimedPose> odometry;   ///< Of the base, in order of time.
  double around_s = 0.0;                 ///< Lateness of odometry, roughly.
};

/// A turn [rad] or a way of the laser [m] between two scans, by registration.
struct MotionByScans {
  double first_s = 0.0;
  double second_s = 0.0;
  double by_scans = 0.0;
  double sigma = 1.0;
};

struct MotionsByScans {
  std::vector<MotionByScans> turns;
  std::vector<MotionByScans> ways;  ///< Of pairs that hardly turn.

  std::size_t count() const { return turns.size() + ways.size(); }
};

/// Of the pairs that register well, from odometry's motion.
MotionsByScans motions_by_scans(const LogToTime& log);

/// Lateness of odometry's stamps against those of the scans, to some milliseconds: by least squares
/// with a factor of the turns and one of the ways, robust. None where the motions do not determine
/// it. A scan is stamped at its first beam: of a scanner that sweeps, odometry seems late by half
/// of the sweep.
std::optional<OdometryTiming> odometry_timing(const MotionsByScans& motions, const LogToTime& log);

/// The same where lateness changes evenly over the drive, if that is certain: to five sigmas and
/// 0.02 s, and if it explains the motions clearly better than one lateness does.
std::optional<OdometryDrift> odometry_drift(const MotionsByScans& motions, const LogToTime& log);

}  // namespace slammot::matching
