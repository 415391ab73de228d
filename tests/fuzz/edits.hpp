#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace slammot::fuzz {

/// Reads `edits` as places [4 bytes] and what stands there instead [8 bytes], and applies them to
/// the example: reaches the inside of a large file with few bytes. A last place without bytes is
/// where the file is cut.
inline std::string edited(std::string example, std::string_view edits) {
  constexpr std::size_t kPlace = 4, kNew = 8;
  while (edits.size() >= kPlace && !example.empty()) {
    std::uint32_t number = 0;
    std::memcpy(&number, edits.data(), kPlace);
    const std::size_t place = number % example.size();
    edits.remove_prefix(kPlace);
    if (edits.empty()) {
      example.resize(place);
      break;
    }
    const std::size_t length = std::min({kNew, edits.size(), example.size() - place});
    std::copy_n(edits.begin(), length, example.begin() + static_cast<std::ptrdiff_t>(place));
    edits.remove_prefix(std::min(kNew, edits.size()));
  }
  return example;
}

}  // namespace slammot::fuzz
