#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/gateway/map_view.hpp"

namespace slammot::gateway {

/// Serialized foxglove.Grid of the whole map, in map.
struct MapGrids {
  std::string stationary;
  std::string moving;
};

/// Larger maps are drawn in larger cells.
inline constexpr std::uint64_t kMostGridCells = std::uint64_t{1} << 20;

/// Takes seconds for a long drive. Coloured by red, green, blue and alpha; unseen cells are
/// transparent.
MapGrids map_grids(std::int64_t stamp_ns, const std::vector<ShownSubmap>& submaps,
                   std::uint64_t most_cells = kMostGridCells);

}  // namespace slammot::gateway
