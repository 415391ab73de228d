#pragma once

#include <span>
#include <vector>

#include "common/grids/surfel_map.hpp"
#include "common/matching/point_to_line.hpp"

namespace slammot::matching {

/// The same place as the target and as the source has it.
struct PointPair {
  geometry::Vector2 in_target_m;
  geometry::Vector2 in_source_m;
};

/// target_from_source that brings the pairs nearest to each other (least squares, closed form): Lu and Milios 1994; Wang
/// 2004, Eqs. (3.5)-(3.7), whose T_y has a and b exchanged. Identity for no pairs; one pair is not turned.
geometry::Pose2 align_pairs(std::span<const PointPair> pairs);

struct IcpConfig {
  int coarse_steps = 20;           ///< At most, with the wide gate,
  int fine_steps = 30;             ///< then with the narrow one.
  double coarse_gate_m = 0.6;      ///< Points farther than this from the nearest one of the map do not count.
  double fine_gate_m = 0.3;
  double converged_m = 1e-4;
};

struct IcpResult {
  geometry::Pose2 map_from_base;
  int matched_points = 0;
  int steps = 0;
};

/// Iterates pairing with the nearest surfel's mean and the closed-form step. Converges slowly where surfaces are smooth and
/// gives no covariance: the baseline that PointToLineMatcher is measured against, not a part of the product. The initial
/// pose is the result when nothing matches.
IcpResult match_by_icp(const std::vector<MatchPoint>& points, const grids::SurfelMap& surfels,
                       const geometry::Pose2& initial_map_from_base, const IcpConfig& config);

}  // namespace slammot::matching
