#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/geometry/pose2.hpp"
#include "common/metrics/scene.hpp"

namespace slammot::metrics {

enum class CellState : std::uint8_t { kUnknown, kFree, kOccupied };

/// Cell (column, row) covers [column, column + 1) * cell_size_m + min_x_m of x in map, and so for y; row-major, row 0
/// lowest y.
struct OccupancyCells {
  std::size_t columns = 0;
  std::size_t rows = 0;
  double cell_size_m = 0.0;
  double min_x_m = 0.0;
  double min_y_m = 0.0;
  std::vector<CellState> state;
};

/// A piece of what truly stood still, in the world's frame.
struct WallSegment {
  geometry::Vector2 from_m = geometry::Vector2::Zero();
  geometry::Vector2 to_m = geometry::Vector2::Zero();
};

struct MapQuality {
  std::size_t occupied_cells = 0;
  std::size_t right_cells = 0;     ///< Occupied with a wall within the tolerance.
  std::size_t residue_cells = 0;   ///< Occupied, no wall near, and an object in motion was there.
  std::size_t wall_samples = 0;    ///< Of walls that were seen, one a cell's width.
  std::size_t mapped_samples = 0;  ///< With an occupied cell within the tolerance.

  double precision() const;
  double recall() const;
  double residue() const;          ///< Share of the occupied cells.
};

/// Everything in the world's frame.
struct MapTruth {
  std::vector<WallSegment> walls;
  std::vector<TrueObject> moving;                  ///< Every place in which an object was while it moved.
  std::vector<geometry::Vector2> wall_echoes_m;    ///< Echoes of what stands still, cast from true poses; empty where unknown,
  std::vector<geometry::Vector2> object_echoes_m;  ///< and of objects, moving or not; empty where unknown.
};

/// Compares occupied cells with the truth. A wall counts where it was seen: an echo is within half the tolerance or, where
/// echoes are unknown, a known cell is within the tolerance. An object leaves residue only where it sent an echo from, to
/// within the tolerance, where echoes are known: the ground that a pitching scanner hits is not its doing.
MapQuality map_quality(const OccupancyCells& map, const geometry::Pose2& world_from_map, const MapTruth& truth, double tolerance_m);

}  // namespace slammot::metrics
