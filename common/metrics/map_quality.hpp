#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/geometry/pose2.hpp"
#include "common/metrics/scene.hpp"

namespace slammot::metrics {

enum class CellState : std::uint8_t { kUnknown, kFree, kOccupied };

/// Cell (column, row) covers [column, column + 1) * cell_size_m + min_x_m of x in map, and so for
/// y; row-major, row 0 lowest y.
struct OccupancyCells {
  std::size_t columns = 0;
  std::size_t rows = 0;
  double cell_size_m = 0.0;
  double min_x_m = 0.0;
  double min_y_m = 0.0;
  std::vector<CellState> state;
};

/// A segment of a stationary surface, in the world's frame.
struct WallSegment {
  geometry::Vector2 from_m = geometry::Vector2::Zero();
  geometry::Vector2 to_m = geometry::Vector2::Zero();
};

struct MapQuality {
  std::size_t occupied_cells = 0;
  std::size_t right_cells = 0;     ///< Occupied with a wall within the tolerance.
  std::size_t residue_cells = 0;   ///< Occupied, without a wall nearby, where a moving object was.
  std::size_t wall_samples = 0;    ///< Of visible walls, one per cell width.
  std::size_t mapped_samples = 0;  ///< With an occupied cell within the tolerance.

  double precision() const;
  double recall() const;
  double residue() const;  ///< Share of the occupied cells.
};

/// Ground truth in the world's frame.
struct MapTruth {
  std::vector<WallSegment> walls;
  std::vector<TrueObject> moving;                  ///< Every pose of an object while it moved.
  std::vector<geometry::Vector2> wall_echoes_m;    ///< Echoes of stationary surfaces, from true
                                                   ///< poses; empty if unknown.
  std::vector<geometry::Vector2> object_echoes_m;  ///< Echoes of objects, moving or not; empty if
                                                   ///< unknown.
};

/// Compares occupied cells with the truth. A wall counts if it was seen: an echo is within half the
/// tolerance or, if echoes are unknown, a known cell is within the tolerance. If echoes are known,
/// an object leaves residue only within the tolerance of its echoes: ground hit by a pitching
/// scanner is excluded.
MapQuality map_quality(const OccupancyCells& map, const geometry::Pose2& world_from_map,
                       const MapTruth& truth, double tolerance_m);

}  // namespace slammot::metrics
