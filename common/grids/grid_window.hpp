#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include <Eigen/Core>

namespace slammot::grids {

/// Cell of an unbounded lattice over a frame: (column, row) covers [column, column + 1) * cell size
/// of x, and likewise of y.
struct Cell {
  std::int32_t column = 0;
  std::int32_t row = 0;
  bool operator==(const Cell&) const = default;
};

/// Coordinate rounded down. On x86-64 without the rounding instruction std::floor is a function
/// call, which would be slow in each cell look-up.
inline std::int32_t whole_below(double place) {
  const auto towards_zero = static_cast<std::int32_t>(place);
  return towards_zero - (static_cast<double>(towards_zero) > place &&
                         towards_zero > std::numeric_limits<std::int32_t>::min());
}

/// Rectangle of the lattice that a grid covers, row-major from the lowest row. Windows with the
/// same cell size share the lattice, so that copies need no resampling.
struct GridWindow {
  double cell_size_m = 0.2;
  Cell first;  ///< Lowest column and row.
  std::int32_t columns = 0;
  std::int32_t rows = 0;

  bool operator==(const GridWindow&) const = default;

  std::size_t cell_count() const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }

  Cell cell_at(double x_m, double y_m) const {
    return {whole_below(x_m / cell_size_m), whole_below(y_m / cell_size_m)};
  }

  bool contains(Cell cell) const {
    // Unsigned arithmetic: differences of far cells must not overflow.
    return static_cast<std::uint32_t>(cell.column) - static_cast<std::uint32_t>(first.column) <
               static_cast<std::uint32_t>(columns) &&
           static_cast<std::uint32_t>(cell.row) - static_cast<std::uint32_t>(first.row) <
               static_cast<std::uint32_t>(rows);
  }

  /// Index in the array; the cell must be inside.
  std::size_t index(Cell cell) const {
    return static_cast<std::size_t>(cell.row - first.row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(cell.column - first.column);
  }

  Eigen::Vector2d centre_of(Cell cell) const {
    return {(cell.column + 0.5) * cell_size_m, (cell.row + 0.5) * cell_size_m};
  }
};

/// Square window of side_m around a point.
GridWindow window_around(const Eigen::Vector2d& centre_m, double side_m, double cell_size_m);

/// Intersection of two windows of one lattice; no columns or rows if empty.
GridWindow intersection(const GridWindow& a, const GridWindow& b);

}  // namespace slammot::grids
