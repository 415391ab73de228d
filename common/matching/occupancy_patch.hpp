#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/geometry/uncertain_pose2.hpp"
#include "common/grids/grid_window.hpp"

namespace slammot::matching {

/// Where an echo came from, and how sure that is.
struct UncertainPoint {
  geometry::Vector2 mean_m;
  geometry::Matrix2 covariance_m2 = geometry::Matrix2::Zero();
};

/// A cell of a patch that may be occupied.
struct OccupiedCell {
  geometry::Vector2 centre_m;
  double evidence = 0.0;        ///< In [0, 1): 2 p - 1, what speaks for it beyond not knowing.
};

/// Occupancy of a patch of the plane by measurements that carry their noise: each spreads its one echo over the cells that
/// it may have come from, and the log-odds of what several say of one cell are added; Wang 2004, Eq. (3.8), after Elfes
/// 1990. Free space is not told of.
class OccupancyPatch {
 public:
  OccupancyPatch() = default;

  /// As large as the points need; in their frame.
  OccupancyPatch(std::span<const UncertainPoint> points, double cell_size_m);

  /// As OccupiedCell::evidence, between the four nearest centres of cells; 0 where no point tells of any.
  double evidence_at(const geometry::Vector2& point_m) const;

  /// Cells with at least so much evidence, row by row.
  std::vector<OccupiedCell> occupied(double least_evidence) const;

 private:
  void add_log_odds(const UncertainPoint& point);
  double evidence(std::int32_t column, std::int32_t row) const;

  grids::GridWindow window_;
  std::vector<float> log_odds_;
  std::vector<float> evidence_;   ///< The same as OccupiedCell has it: looked up often, computed once.
};

/// How strongly two patches are related when one is laid on the other: the sum of the products of their cells, Wang 2004,
/// Eq. (3.9), as a share of the source's own sum, so that it lies in [0, 1). 0 for a source without cells.
double correlation(const OccupancyPatch& target, std::span<const OccupiedCell> source, const geometry::Pose2& target_from_source);

}  // namespace slammot::matching
