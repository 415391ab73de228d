#pragma once

#include "common/traffic/traffic_map.hpp"
#include "common/traffic/way.hpp"

namespace slammot::traffic {

/// Lanes, cycle lanes and walkways of the map: ridges of its streams, cut into pieces of at most
/// 25 m, so that speed, width and confidence are those of the place.
///
/// Confidence of n tracks whose directions have the mean resultant length R: n R / (n + 1), the
/// resultant length of these and one track of unknown direction.
std::vector<Way> find_ways(const TrafficMap& map);

}  // namespace slammot::traffic
