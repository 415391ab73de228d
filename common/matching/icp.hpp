#pragma once

#include <span>
#include <vector>

#include "common/grids/surfel_map.hpp"
#include "common/matching/point_to_line.hpp"

namespace slammot::matching {

/// A pair of corresponding points in the target and the source frame.
struct PointPair {
  geometry::Vector2 in_target_m;
  geometry::Vector2 in_source_m;
};

/// target_from_source by least squares over the pairs, in closed form: Lu and Milios 1994; Wang
/// 2004, Eqs. (3.5)-(3.7), whose T_y has a and b exchanged. Identity for no pairs; one pair gives
/// no rotation.
geometry::Pose2 align_pairs(std::span<const PointPair> pairs);

struct IcpConfig {
  int coarse_steps = 20;       ///< Most iterations with the wide gate.
  int fine_steps = 30;         ///< Most iterations with the narrow gate.
  double coarse_gate_m = 0.6;  ///< Points farther than this from the nearest map point are ignored.
  double fine_gate_m = 0.3;
  double converged_m = 1e-4;
};

struct IcpResult {
  geometry::Pose2 map_from_base;
  int matched_points = 0;
  int steps = 0;
};

/// Point-to-point ICP: pairs each point with the nearest surfel's mean and takes the closed-form
/// step. It converges slowly on smooth surfaces and gives no covariance. It is the baseline for
/// PointToLineMatcher, not part of the product. Returns the initial pose if nothing matches.
IcpResult match_by_icp(const std::vector<MatchPoint>& points, const grids::SurfelMap& surfels,
                       const geometry::Pose2& initial_map_from_base, const IcpConfig& config);

}  // namespace slammot::matching
