#pragma once

#include <string>

#include "common/traffic/traffic_ways.hpp"
#include "foxglove.pb.h"

namespace slammot::gateway {

/// Lanes and walkways as wide as they are used, fainter where few objects went, with an arrow in
/// the middle of each that has a direction. One entity, which the next message replaces.
foxglove::SceneUpdate ways_scene(const traffic::TrafficWays& ways);

/// Everything known about each piece; points as a flat list of x, y in map.
std::string ways_json(const traffic::TrafficWays& ways);

}  // namespace slammot::gateway
