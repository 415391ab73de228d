#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "services/tracking/scan_history.hpp"

namespace slammot::tracking {

/// Speed along a direction, and its sigma.
struct SpeedEvidence {
  double speed_mps = 0.0;
  double sigma_mps = 0.0;
};

/// The echoes of an object that moves along a known direction.
struct DirectedEchoes {
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  ///< Unit vector, in odom.
  std::span<const Eigen::Vector2d> points_m;             ///< In odom; at least one.
  std::int64_t stamp_ns = 0;                             ///< Of their scan.
  flow::TrackId own;                                     ///< The track of the echoes.
};

/// Speed along the direction by earlier scans. For each speed the echoes are moved back to earlier
/// scans: places that those saw through speak against the speed, places with echoes for it. Needs
/// neither ends nor shape of the object, so that a partly hidden flank is no more certain than it
/// can be. fastest_mps: of the search. Without earlier scans the speed is 0 with a sigma of half of
/// fastest_mps. Cost: 3 scans x 29 speeds x 8 echoes.
SpeedEvidence speed_along(const DirectedEchoes& echoes, const ScanHistory& history,
                          double fastest_mps);

}  // namespace slammot::tracking
