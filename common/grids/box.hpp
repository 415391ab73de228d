#pragma once

#include <cmath>

#include <Eigen/Core>

#include "common/grids/grid_window.hpp"

namespace slammot::grids {

/// Oriented rectangle in a grid's frame.
struct Box {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();  ///< Direction of its length.
  Eigen::Vector2d half_m = Eigen::Vector2d::Zero();  ///< Of its length and its width.

  bool covers(const Eigen::Vector2d& point_m) const {
    const Eigen::Vector2d way_m = point_m - centre_m;
    return std::abs(along.dot(way_m)) <= half_m.x() &&
           std::abs(along.x() * way_m.y() - along.y() * way_m.x()) <= half_m.y();
  }
};

/// Range from low to high, inclusive; empty if low is beyond high.
struct CellRange {
  Cell low;
  Cell high{-1, -1};

  bool is_empty() const { return low.column > high.column || low.row > high.row; }
};

/// Range of cells of the window that contains all cells whose centres the box covers.
inline CellRange cells_around(const Box& box, const GridWindow& window) {
  const Eigen::Vector2d along = box.along.cwiseAbs();
  const Eigen::Vector2d reach_m(along.x() * box.half_m.x() + along.y() * box.half_m.y(),
                                along.y() * box.half_m.x() + along.x() * box.half_m.y());
  const Cell end{window.first.column + window.columns - 1, window.first.row + window.rows - 1};
  const Eigen::Vector2d low_m = (box.centre_m - reach_m).cwiseMax(window.centre_of(window.first));
  const Eigen::Vector2d high_m = (box.centre_m + reach_m).cwiseMin(window.centre_of(end));
  if ((low_m.array() > high_m.array()).any())
    return {};  // before conversion: cells of far coordinates overflow
  return {window.cell_at(low_m.x(), low_m.y()), window.cell_at(high_m.x(), high_m.y())};
}

}  // namespace slammot::grids
