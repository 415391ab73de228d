#pragma once

#include <cstdint>

#include "common/flow/ids.hpp"

namespace slammot::flow {

/// Summary of a vehicle's latest stored map, needed before a drive continues in it.
struct StoredMap {
  MapId map_id{};
  std::uint32_t submaps = 0;     ///< Number of readable submaps; 0 if nothing is stored.
  std::uint32_t unreadable = 0;  ///< Number of damaged submaps.
  SubmapId last_submap_id;       ///< Highest number in use, readable or not.
  double cell_size_m = 0.0;      ///< Of all its submaps; 0 if none is readable.
};

}  // namespace slammot::flow
