#include "common/grids/grid_window.hpp"

#include <algorithm>

namespace slammot::grids {

GridWindow window_around(const Eigen::Vector2d& centre_m, double side_m, double cell_size_m) {
  GridWindow window;
  window.cell_size_m = cell_size_m;
  const auto half = static_cast<std::int32_t>(std::ceil(0.5 * side_m / cell_size_m));
  const Cell centre = window.cell_at(centre_m.x(), centre_m.y());
  window.first = {centre.column - half, centre.row - half};
  window.columns = 2 * half;
  window.rows = 2 * half;
  return window;
}

GridWindow intersection(const GridWindow& a, const GridWindow& b) {
  GridWindow shared;
  shared.cell_size_m = a.cell_size_m;
  shared.first = {std::max(a.first.column, b.first.column), std::max(a.first.row, b.first.row)};
  shared.columns = std::max(
      0, std::min(a.first.column + a.columns, b.first.column + b.columns) - shared.first.column);
  shared.rows =
      std::max(0, std::min(a.first.row + a.rows, b.first.row + b.rows) - shared.first.row);
  return shared;
}

}  // namespace slammot::grids
