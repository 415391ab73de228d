#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace slammot::recorder {

/// RFC 4648, section 4.
std::string to_base64(std::span<const std::uint8_t> bytes);

/// None for a text that is not such.
std::optional<std::vector<std::uint8_t>> from_base64(std::string_view text);

}  // namespace slammot::recorder
