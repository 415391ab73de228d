#pragma once

#include <cmath>

#include "common/geometry/uncertain_pose2.hpp"

namespace slammot::localization {

/// Result of matching one scan against the local map.
struct ScanMatch {
  geometry::UncertainPose2 odom_from_base;
  bool is_believed = false;     ///< Otherwise odom_from_base is the prediction.
  bool was_sampled = false;     ///< Some direction was left to the prediction.
  bool is_lost = false;         ///< There were enough points, and they did not match.
  bool was_searched = false;    ///< By correlation, before it was refined.
  double rms_residual_m = 0.0;  ///< Of a believed match.
  double matched_share = 0.0;   ///< Of the points.
  double new_share = 0.0;  ///< Share of the matched map that is new; 0 where was_sampled: the map
                           ///< says nothing of that direction.
};

/// Share of the matched map that a way of moved_m renews. new_below_m: see PointToLineConfig.
inline double renewed_share(const ScanMatch& match, double moved_m, double new_below_m) {
  return 1.0 - std::exp(-moved_m * match.new_share / new_below_m);
}

}  // namespace slammot::localization
