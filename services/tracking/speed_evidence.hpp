#pragma once

#include <span>

#include <Eigen/Core>

#include "services/tracking/scan_history.hpp"

namespace slammot::tracking {

/// How fast something seems to go along a direction, and how surely.
struct SpeedEvidence {
  double speed_mps = 0.0;
  double sigma_mps = 0.0;
};

/// Speed along a direction (unit length, in odom) of what sends these echoes (in odom, at stamp_ns), from where earlier
/// scans saw through and where they had echoes: had it that speed, its echoes would have come from there. Needs neither ends
/// nor shape of the object, so that a flank of which an unknown part is hidden says no more than it can. fastest_mps: no
/// faster ones are tried; own: whose echoes they are; without a past the speed is 0, one sigma half of that. Cost: 3 scans, 29 speeds, 8 echoes.
SpeedEvidence speed_along(const Eigen::Vector2d& direction, std::span<const Eigen::Vector2d> echoes_m, std::int64_t stamp_ns,
                          const ScanHistory& history, double fastest_mps, flow::TrackId own);

}  // namespace slammot::tracking
