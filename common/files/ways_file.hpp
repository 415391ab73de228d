#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "common/files/result.hpp"
#include "common/traffic/way.hpp"

namespace slammot::files {

/// GeoJSON, one LineString a line, in metres of the frame map, not in degrees. Properties: kind
/// (lane, cycle_lane, walkway), line, speed, speed_spread [m/s], width [m], tracks, confidence.
std::string to_geojson(const std::vector<traffic::Way>& ways);

/// Reads what to_geojson() writes. Fails with one line if the text is anything else.
Result<std::vector<traffic::Way>> parse_ways(std::string_view text, const std::string& name);

Result<std::vector<traffic::Way>> read_ways(const std::filesystem::path& file);

}  // namespace slammot::files
