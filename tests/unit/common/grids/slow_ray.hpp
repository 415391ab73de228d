#pragma once

#include <algorithm>
#include <limits>
#include <optional>

#include <Eigen/Core>

#include "common/grids/grid_window.hpp"

namespace slammot::grids {

/// The part of a ray that lies in a cell, as distances from its origin.
struct Passage {
  double in_m = 0.0;
  double out_m = 0.0;
  double length_m() const { return out_m - in_m; }
};

/// Cuts a ray with one cell's square, side by side; the oracle for everything that walks along
/// rays.
inline std::optional<Passage> passage_through(Cell cell, double cell_size_m,
                                              const Eigen::Vector2d& origin_m,
                                              const Eigen::Vector2d& direction) {
  Passage passage{0.0, std::numeric_limits<double>::infinity()};
  const Eigen::Vector2d low_m(cell.column * cell_size_m, cell.row * cell_size_m);
  for (int axis = 0; axis < 2; ++axis) {
    const double to_low_m = low_m[axis] - origin_m[axis];
    const double to_high_m = to_low_m + cell_size_m;
    if (direction[axis] == 0.0) {
      if (to_low_m > 0.0 || to_high_m <= 0.0) return std::nullopt;
      continue;
    }
    const double a = to_low_m / direction[axis], b = to_high_m / direction[axis];
    passage.in_m = std::max(passage.in_m, std::min(a, b));
    passage.out_m = std::min(passage.out_m, std::max(a, b));
  }
  if (passage.out_m <= passage.in_m) return std::nullopt;
  return passage;
}

}  // namespace slammot::grids
