#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace slammot::files {

/// RFC 4648, section 4, with padding.
std::string to_base64(std::span<const std::uint8_t> bytes);
std::string to_base64(std::string_view bytes);

/// None for a text that is not such.
std::optional<std::vector<std::uint8_t>> from_base64(std::string_view text);

}  // namespace slammot::files
