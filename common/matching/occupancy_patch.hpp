#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/geometry/uncertain_pose2.hpp"
#include "common/grids/grid_window.hpp"

namespace slammot::matching {

/// Position of an echo with its covariance.
struct UncertainPoint {
  geometry::Vector2 mean_m;
  geometry::Matrix2 covariance_m2 = geometry::Matrix2::Zero();
};

/// A cell of a patch that may be occupied.
struct OccupiedCell {
  geometry::Vector2 centre_m;
  double evidence = 0.0;  ///< In [0, 1): 2 p - 1, the evidence of occupancy beyond the prior.
};

/// Occupancy of a patch of the plane from noisy measurements. Each echo is spread over the cells
/// that it may have come from; log-odds of several echoes are added; Wang 2004, Eq. (3.8), after
/// Elfes 1990. Free space is not modelled.
class OccupancyPatch {
 public:
  OccupancyPatch() = default;

  /// Patch that encloses the points, in their frame.
  OccupancyPatch(std::span<const UncertainPoint> points, double cell_size_m);

  /// OccupiedCell::evidence by bilinear interpolation; 0 where no point contributes.
  double evidence_at(const geometry::Vector2& point_m) const;

  /// Cells with at least this evidence, row by row.
  std::vector<OccupiedCell> occupied(double least_evidence) const;

 private:
  void add_log_odds(const UncertainPoint& point);
  double evidence(std::int32_t column, std::int32_t row) const;

  grids::GridWindow window_;
  std::vector<float> log_odds_;
  std::vector<float> evidence_;  ///< Cached OccupiedCell::evidence.
};

/// Correlation of two patches: sum of the products of their cells, Wang 2004, Eq. (3.9), divided by
/// the source's own sum; in [0, 1). 0 for a source without cells.
double correlation(const OccupancyPatch& target, std::span<const OccupiedCell> source,
                   const geometry::Pose2& target_from_source);

}  // namespace slammot::matching
