#include "common/metrics/map_quality.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/segment.hpp"
#include "common/metrics/share.hpp"

namespace slammot::metrics {
namespace {

using geometry::Pose2;
using geometry::Vector2;

struct CellRange {
  std::ptrdiff_t first_column = 0, last_column = -1, first_row = 0, last_row = -1;
};

/// Cells whose centre may be within reach of the point, inside the map.
CellRange cells_around(const OccupancyCells& map, const Vector2& point_in_map_m, double reach_m) {
  const auto index = [&](double offset_m) {
    return static_cast<std::ptrdiff_t>(std::floor(offset_m / map.cell_size_m));
  };
  return {std::max<std::ptrdiff_t>(0, index(point_in_map_m.x() - reach_m - map.min_x_m)),
          std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(map.columns) - 1,
                                   index(point_in_map_m.x() + reach_m - map.min_x_m)),
          std::max<std::ptrdiff_t>(0, index(point_in_map_m.y() - reach_m - map.min_y_m)),
          std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(map.rows) - 1,
                                   index(point_in_map_m.y() + reach_m - map.min_y_m))};
}

/// Calls visit(cell index, centre in map) for each cell of the range.
template <typename Visit>
void for_each_cell(const OccupancyCells& map, const CellRange& range, Visit visit) {
  for (std::ptrdiff_t row = range.first_row; row <= range.last_row; ++row) {
    for (std::ptrdiff_t column = range.first_column; column <= range.last_column; ++column) {
      const Vector2 centre_m{map.min_x_m + (static_cast<double>(column) + 0.5) * map.cell_size_m,
                             map.min_y_m + (static_cast<double>(row) + 0.5) * map.cell_size_m};
      visit(static_cast<std::size_t>(row) * map.columns + static_cast<std::size_t>(column),
            centre_m);
    }
  }
}

double distance_m(const Vector2& point_m, const WallSegment& wall) {
  return (geometry::nearest_on_segment(wall.from_m, wall.to_m, point_m) - point_m).norm();
}

/// Calls visit(point) along the wall, at most step_m apart, both ends too.
template <typename Visit>
void walk(const WallSegment& wall, double step_m, Visit visit) {
  const int steps =
      std::max(1, static_cast<int>(std::ceil((wall.to_m - wall.from_m).norm() / step_m)));
  for (int i = 0; i <= steps; ++i)
    visit(Vector2(wall.from_m + (static_cast<double>(i) / steps) * (wall.to_m - wall.from_m)));
}

std::vector<char> cells_near_walls(const OccupancyCells& map,
                                   const std::vector<WallSegment>& walls_in_map,
                                   double tolerance_m) {
  std::vector<char> is_near(map.state.size(), 0);
  for (const WallSegment& wall : walls_in_map) {
    walk(wall, map.cell_size_m, [&](const Vector2& point_m) {
      for_each_cell(map, cells_around(map, point_m, tolerance_m + map.cell_size_m),
                    [&](std::size_t cell, const Vector2& centre_m) {
                      if (distance_m(centre_m, wall) <= tolerance_m) is_near[cell] = 1;
                    });
    });
  }
  return is_near;
}

/// Places where echoes came from, as cells of their own size over the map's frame.
class EchoPlaces {
 public:
  EchoPlaces(const std::vector<Vector2>& echoes_in_map_m, double size_m) : size_m_(size_m) {
    for (const Vector2& echo_m : echoes_in_map_m)
      places_.push_back(key(place(echo_m.x()), place(echo_m.y())));
    std::sort(places_.begin(), places_.end());
    places_.erase(std::unique(places_.begin(), places_.end()), places_.end());
  }

  bool is_near(const Vector2& point_m) const {
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        if (std::binary_search(places_.begin(), places_.end(),
                               key(place(point_m.x()) + dx, place(point_m.y()) + dy)))
          return true;
      }
    }
    return false;
  }

 private:
  std::int64_t place(double coordinate_m) const {
    return static_cast<std::int64_t>(std::floor(coordinate_m / size_m_));
  }
  static std::uint64_t key(std::int64_t x, std::int64_t y) {
    return (static_cast<std::uint64_t>(x) << 32) + static_cast<std::uint64_t>(y);
  }

  double size_m_;
  std::vector<std::uint64_t> places_;
};

std::vector<Vector2> moved(std::vector<Vector2> points_m, const Pose2& by) {
  for (Vector2& point_m : points_m) point_m = by * point_m;
  return points_m;
}

/// Occupied cells in which an object in motion was, and from which, where that is known, one sent
/// an echo.
std::vector<char> cells_of_movers(const OccupancyCells& map, const Pose2& map_from_world,
                                  const MapTruth& truth, double tolerance_m) {
  const EchoPlaces echoes(moved(truth.object_echoes_m, map_from_world), tolerance_m);
  std::vector<char> is_mover(map.state.size(), 0);
  for (TrueObject object : truth.moving) {
    object.world_from_object = map_from_world * object.world_from_object;
    const double reach_m = 0.5 * std::hypot(object.length_m, object.width_m) + map.cell_size_m;
    for_each_cell(map, cells_around(map, object.world_from_object.translation_m(), reach_m),
                  [&](std::size_t cell, const Vector2& centre_m) {
                    if (map.state[cell] != CellState::kOccupied || is_mover[cell] ||
                        distance_to_box_m(centre_m, object) > 0.5 * map.cell_size_m)
                      return;
                    is_mover[cell] =
                        truth.object_echoes_m.empty() || echoes.is_near(centre_m) ? 1 : 0;
                  });
  }
  return is_mover;
}

}  // namespace

double MapQuality::precision() const { return share(right_cells, occupied_cells); }
double MapQuality::recall() const { return share(mapped_samples, wall_samples); }
double MapQuality::residue() const { return share(residue_cells, occupied_cells); }

MapQuality map_quality(const OccupancyCells& map, const Pose2& world_from_map,
                       const MapTruth& truth, double tolerance_m) {
  const Pose2 map_from_world = geometry::inverse(world_from_map);
  std::vector<WallSegment> walls_in_map;
  for (const WallSegment& wall : truth.walls)
    walls_in_map.push_back({map_from_world * wall.from_m, map_from_world * wall.to_m});
  const std::vector<char> is_near_wall = cells_near_walls(map, walls_in_map, tolerance_m);
  const std::vector<char> is_mover = cells_of_movers(map, map_from_world, truth, tolerance_m);
  MapQuality quality;
  for (std::size_t cell = 0; cell < map.state.size(); ++cell) {
    if (map.state[cell] != CellState::kOccupied) continue;
    ++quality.occupied_cells;
    quality.right_cells += is_near_wall[cell] ? 1 : 0;
    quality.residue_cells += !is_near_wall[cell] && is_mover[cell] ? 1 : 0;
  }
  const EchoPlaces echoes(moved(truth.wall_echoes_m, map_from_world), 0.5 * tolerance_m);
  for (const WallSegment& wall : walls_in_map) {
    walk(wall, map.cell_size_m, [&](const Vector2& point_m) {
      bool is_known = false;
      bool is_mapped = false;
      for_each_cell(map, cells_around(map, point_m, tolerance_m),
                    [&](std::size_t cell, const Vector2& centre_m) {
                      if ((centre_m - point_m).norm() > tolerance_m) return;
                      is_known = is_known || map.state[cell] != CellState::kUnknown;
                      is_mapped = is_mapped || map.state[cell] == CellState::kOccupied;
                    });
      const bool is_seen = truth.wall_echoes_m.empty() ? is_known : echoes.is_near(point_m);
      if (!is_seen) return;
      ++quality.wall_samples;
      quality.mapped_samples += is_mapped ? 1 : 0;
    });
  }
  return quality;
}

}  // namespace slammot::metrics
