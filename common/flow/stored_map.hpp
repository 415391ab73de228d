#pragma once

#include <cstdint>

#include "common/flow/ids.hpp"

namespace slammot::flow {

/// What is stored of a vehicle's latest map: all that has to be known of it before a drive goes on in it.
struct StoredMap {
  MapId map_id{};
  std::uint32_t submaps = 0;     ///< That can be read; 0 where nothing is stored.
  std::uint32_t unreadable = 0;  ///< Damaged ones.
  SubmapId last_submap_id;       ///< The highest number that is taken, readable or not.
  double cell_size_m = 0.0;      ///< Of all its submaps; 0 where none can be read.
};

}  // namespace slammot::flow
