#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "common/flow/submap.hpp"

namespace slammot::map_store {

/// Serializes a submap for the database: a compressed SubmapRecord.
std::string to_blob(const flow::Submap& submap);

/// Deserializes a submap; nullopt if the blob is damaged or its sizes are inconsistent.
std::optional<flow::Submap> from_blob(std::string_view blob);

}  // namespace slammot::map_store
