#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/traffic/traffic_map.hpp"

namespace slammot::map_store {

/// Serializes streams for the database: a compressed TrafficRecord.
std::string to_traffic_blob(const std::vector<traffic::FreeStream>& streams);

/// nullopt if the blob is damaged, its sizes are inconsistent or its numbers are unsound.
std::optional<std::vector<traffic::FreeStream>> from_traffic_blob(std::string_view blob);

}  // namespace slammot::map_store
