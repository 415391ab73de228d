#pragma once

#include <vector>

#include "common/geometry/pose2.hpp"
#include "common/grids/evidence_grid.hpp"
#include "common/matching/point_to_line.hpp"
#include "services/localization/local_map.hpp"
#include "services/localization/scan_points.hpp"

namespace slammot::localization {

/// Share of contradicting points above which a pose is wrong, where the prediction is vague.
inline constexpr double kMostContradictedShare = 0.5;

constexpr double kFoundByHalf = 0.5;  ///< What the vehicle was lost by must have fallen to this
                                      ///< share where it is found.

/// Of some of a scan's points, how many lie where in the map.
struct MapAgreement {
  int behind_walls = 0;
  int in_free_space = 0;  ///< Where the map has seen through.
  int explained = 0;      ///< On something stationary.

  /// Of the points of which the map knows anything; 0 where it knows too little of them.
  double contradicting_share() const { return share_of_known(behind_walls + in_free_space); }
  double share_behind_walls() const { return share_of_known(behind_walls); }

 private:
  double share_of_known(int points) const;
};

/// How the matched points of a scan, seen from the pose, agree with the map.
MapAgreement agreement(const ScanPoints& points, const geometry::Pose2& odom_from_base,
                       const grids::EvidenceGrid& evidence, const LocalMapConfig& config);

/// How well a scan fits that was matched at the pose: the share of its points that match, less that
/// of those that contradict the map.
double fit_at(double matched_share, const ScanPoints& points, const geometry::Pose2& odom_from_base,
              const LocalMap& map, const LocalMapConfig& config);

/// Share of the points that lie on what the map knows: cheap, and enough to see that all is well.
/// Of none, none.
double explained_share(const std::vector<matching::MatchPoint>& points,
                       const geometry::Pose2& odom_from_base, const grids::EvidenceGrid& evidence,
                       const LocalMapConfig& config);

}  // namespace slammot::localization
