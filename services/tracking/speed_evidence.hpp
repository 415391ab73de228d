#pragma once

#include <span>

#include <Eigen/Core>

#include "services/tracking/scan_history.hpp"

namespace slammot::tracking {

/// Speed along a direction, and its sigma.
struct SpeedEvidence {
  double speed_mps = 0.0;
  double sigma_mps = 0.0;
};

/// Speed along a direction (unit vector, in odom) of the object with these echoes (in odom, at stamp_ns). For each speed the echoes are
/// moved back to earlier scans: places that those saw through speak against the speed, places with echoes for it. Needs neither ends nor shape
/// of the object, so that a partly hidden flank is no more certain than it can be. fastest_mps: of the search; own: the track of the
/// echoes. Without earlier scans the speed is 0 with a sigma of half of fastest_mps. Cost: 3 scans x 29 speeds x 8 echoes.
SpeedEvidence speed_along(const Eigen::Vector2d& direction, std::span<const Eigen::Vector2d> echoes_m, std::int64_t stamp_ns,
                          const ScanHistory& history, double fastest_mps, flow::TrackId own);

}  // namespace slammot::tracking
