#pragma once

#include <optional>
#include <vector>

#include "common/grids/surfel_map.hpp"
#include "common/matching/point_to_line.hpp"

namespace slammot::localization {

/// How long a scanner's sweep really takes, as a factor on what is said of it: -1 for one that
/// sweeps the other way round.
struct SweepFactor {
  double value = 1.0;
  double variance = 0.0;                         ///< 0: known.
  std::optional<Eigen::Vector2d> mapped_motion;  ///< At which the map was made: forward [m/s], yaw
                                                 ///< rate [rad/s].
};

/// What the points of one matched scan tell of it.
struct SweptScan {
  const std::vector<matching::MatchPoint>& points;  ///< Deskewed by the factor as believed,
  const std::vector<double>& share_of_sweep;  ///< each fired after this share of the sweep, in [0,
                                              ///< 1].
  geometry::Pose2 map_from_base;              ///< As matched,
  geometry::Matrix3 prior_information = geometry::Matrix3::Zero();  ///< with this known of the pose
                                                                    ///< beforehand.
  double sweep_s = 0.0;                                             ///< As it is said to take.
  Eigen::Vector2d motion = Eigen::Vector2d::Zero();  ///< Forward [m/s], yaw rate [rad/s].
  double after_s = 0.0;                              ///< Since the scan before.
};

/// The factor with what the residuals across the surfaces say of it: had the sweep taken longer,
/// each point would have been seen from farther along the motion, by its share of the sweep. Pose
/// and factor are solved for together and the pose is left out of the result (Schur complement), as
/// most of a wrong factor looks like a wrong pose. The map was made with the same error: only what
/// differs between the motion now and that of the last moments shows, and a vehicle that goes on as
/// it went learns nothing. Old evidence fades, up to the variance at the start.
SweepFactor learned(const SweepFactor& before, const SweptScan& scan,
                    const grids::SurfelMap& surfels, const matching::PointToLineConfig& config,
                    double variance_at_start);

}  // namespace slammot::localization
