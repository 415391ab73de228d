#pragma once

#include <cmath>
#include <cstdint>

#include "common/geometry/pose2.hpp"

/// A lattice of squares in the plane.
namespace slammot::traffic {

/// Of the square's column or row.
inline std::int32_t square_index(double coordinate_m, double side_m) {
  return static_cast<std::int32_t>(std::floor(coordinate_m / side_m));
}

inline std::uint64_t square_key(std::int32_t column, std::int32_t row) {
  return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(column)) << 32U) |
         static_cast<std::uint32_t>(row);
}

inline std::uint64_t square_key(const geometry::Vector2& position_m, double side_m) {
  return square_key(square_index(position_m.x(), side_m), square_index(position_m.y(), side_m));
}

/// True if the predicate holds for the key of a square that touches the window of that half side.
template <typename Predicate>
bool any_square_near(const geometry::Vector2& centre_m, double half_window_m, double side_m,
                     const Predicate& holds) {
  const std::int32_t last_row = square_index(centre_m.y() + half_window_m, side_m);
  const std::int32_t last_column = square_index(centre_m.x() + half_window_m, side_m);
  for (std::int32_t row = square_index(centre_m.y() - half_window_m, side_m); row <= last_row;
       ++row) {
    for (std::int32_t column = square_index(centre_m.x() - half_window_m, side_m);
         column <= last_column; ++column) {
      if (holds(square_key(column, row))) return true;
    }
  }
  return false;
}

}  // namespace slammot::traffic
