#pragma once

#include <cstdint>
#include <vector>

#include "common/flow/ids.hpp"
#include "common/traffic/way.hpp"

namespace slammot::traffic {

/// Lanes, cycle lanes and walkways of a map, as last published.
struct TrafficWays {
  std::uint32_t sequence = 0;  ///< Increases with every publication.
  std::int64_t stamp_ns = 0;   ///< Of the newest tracks in them.
  flow::MapId map_id{};
  std::vector<Way> ways;
};

}  // namespace slammot::traffic
