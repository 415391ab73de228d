#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "common/flow/submap.hpp"

namespace slammot::map_store {

/// The bytes that the database keeps for a submap: a SubmapRecord, deflated.
std::string to_blob(const flow::Submap& submap);

/// The submap of a blob; nothing when the blob is damaged or its sizes contradict each other.
std::optional<flow::Submap> from_blob(std::string_view blob);

}  // namespace slammot::map_store
