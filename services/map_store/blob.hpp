#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace slammot::map_store {

/// Compresses a record for the database: its length in 4 bytes, little-endian, then its zlib
/// stream.
std::string deflated(std::string_view record);

/// nullopt if the blob is damaged.
std::optional<std::string> inflated(std::string_view blob);

}  // namespace slammot::map_store
