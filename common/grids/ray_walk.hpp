#pragma once

#include <cmath>
#include <limits>

#include <Eigen/Core>

#include "common/grids/grid_window.hpp"

namespace slammot::grids {

/// Cell traversal along a ray; Amanatides and Woo 1987.
class RayWalk {
 public:
  /// direction has unit length.
  RayWalk(const Eigen::Vector2d& origin_m, const Eigen::Vector2d& direction, double cell_size_m)
      : columns_(origin_m.x(), direction.x(), cell_size_m),
        rows_(origin_m.y(), direction.y(), cell_size_m) {}

  Cell cell() const { return {columns_.cell, rows_.cell}; }
  double distance_m() const {
    return distance_m_;
  }  ///< Distance at which the ray entered the cell.

  void advance() {
    Axis& nearer = columns_.next_border_m < rows_.next_border_m ? columns_ : rows_;
    distance_m_ = nearer.next_border_m;
    nearer.next_border_m += nearer.per_cell_m;
    nearer.cell += nearer.step;
  }

  struct Axis {
    Axis(double origin_m, double direction, double cell_size_m)
        : cell(static_cast<std::int32_t>(std::floor(origin_m / cell_size_m))),
          step(direction > 0.0 ? 1 : -1) {
      if (direction == 0.0) return;
      per_cell_m = cell_size_m / std::abs(direction);
      next_border_m = ((cell + (direction > 0.0 ? 1 : 0)) * cell_size_m - origin_m) / direction;
    }
    std::int32_t cell;
    std::int32_t step;
    double per_cell_m = std::numeric_limits<double>::infinity();
    double next_border_m = std::numeric_limits<double>::infinity();
  };

  const Axis& columns() const { return columns_; }
  const Axis& rows() const { return rows_; }

 private:
  Axis columns_;
  Axis rows_;
  double distance_m_ = 0.0;
};

}  // namespace slammot::grids
