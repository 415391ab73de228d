#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/geometry/pose2.hpp"

namespace slammot::streets {

enum class Seen : std::uint8_t { kUnknown, kFree, kOccupied };

/// What scans have seen of the ground, without moving objects: a raster in map, the lowest row
/// first. Empty: nothing was seen.
struct SeenSpace {
  geometry::Vector2 min_m = geometry::Vector2::Zero();
  double cell_m = 0.1;
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::vector<Seen> cells;

  /// Unknown beyond the raster.
  Seen at(const geometry::Vector2& point_m) const {
    const geometry::Vector2 cell = (point_m - min_m) / cell_m;
    if (!(cell.x() >= 0.0 && cell.x() < static_cast<double>(columns))) return Seen::kUnknown;
    if (!(cell.y() >= 0.0 && cell.y() < static_cast<double>(rows))) return Seen::kUnknown;
    return cells[static_cast<std::size_t>(cell.y()) * columns + static_cast<std::size_t>(cell.x())];
  }
};

}  // namespace slammot::streets
