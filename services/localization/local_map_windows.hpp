#pragma once

#include "common/grids/grid_window.hpp"
#include "services/localization/local_map.hpp"

namespace slammot::localization {

/// Window of the evidence of a local map around a place in odom.
inline grids::GridWindow evidence_window(const LocalMapConfig& config,
                                         const geometry::Vector2& centre_m) {
  return grids::window_around(centre_m, config.side_m, config.cell_size_m);
}

/// Window of its surfels.
inline grids::GridWindow surfel_window(const LocalMapConfig& config,
                                       const geometry::Vector2& centre_m) {
  return grids::window_around(centre_m, config.side_m, config.surfel_size_m);
}

}  // namespace slammot::localization
