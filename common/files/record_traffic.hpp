#pragma once

#include <string>
#include <vector>

#include "common/files/run_record.hpp"
#include "common/traffic/traffic_map.hpp"

namespace slammot::files {

/// The tracks of a drive, each with the kind that its class probabilities favour over all scans,
/// in map after the last correction. Without states that are predicted or stopped, and without
/// tracks of unknown class.
std::vector<traffic::Passage> passages_of(const RunRecord& record);

traffic::TrafficMap traffic_of(const RunRecord& record);

/// Content of lanes.geojson.
std::string lanes_geojson(const RunRecord& record);

}  // namespace slammot::files
