#pragma once

#include <span>
#include <vector>

#include "common/geometry/pose2.hpp"

namespace slammot::streets {

/// A way as points at equal distances. Where it turns it follows no line of the graph, so that
/// points there are not compared; a stretch is what lies between two turns.
struct DrivenWay {
  static constexpr double kSpacing_m = 5.0;
  static constexpr int kTurn = -1;

  std::vector<geometry::Pose2> points;  ///< map_from_base.
  std::vector<int> stretches;           ///< Number of each point's stretch, or kTurn.

  double length_m() const;
  /// Distance of the farthest point from the first one.
  double reach_m() const;
};

/// poses: in the order of the drive, of any spacing.
DrivenWay driven_way(std::span<const geometry::Pose2> poses);

}  // namespace slammot::streets
