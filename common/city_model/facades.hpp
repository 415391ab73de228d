#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/pose2.hpp"

namespace slammot::city_model {

/// An echo in map, with its height above the road where it was scanned.
struct PlacedEcho {
  Eigen::Vector3f position_in_map_m = Eigen::Vector3f::Zero();
  std::uint32_t scan = 0;  ///< Counted from 0: identifies the echo in the log,
  std::uint16_t beam = 0;  ///< with its beam.
};

/// Column of the 2.5-D model.
using Cell = std::pair<int, int>;
using Columns = std::map<Cell, std::vector<PlacedEcho>>;

Cell cell_of(const Eigen::Vector3f& position_in_map_m, double cell_size_m);

/// An upright rectangle of the model.
struct Facade {
  geometry::Vector2 from_m = geometry::Vector2::Zero();  ///< In map.
  geometry::Vector2 to_m = geometry::Vector2::Zero();
  double bottom_m = 0.0;  ///< Above the road.
  double top_m = 0.0;
};

/// Bottom and top of what was hit, without single echoes far above or below the others.
struct Span {
  double bottom_m = 0.0;
  double top_m = 0.0;
};
Span span_of(std::span<const PlacedEcho> echoes);

/// One facade for each column with enough echoes: a line along the surface in the column and its
/// neighbours, as long as the column where they form a line, otherwise as wide as the echoes are
/// spread. What begins near the road is continued down to it.
std::vector<Facade> facades_of(const Columns& columns, double cell_size_m);

}  // namespace slammot::city_model
