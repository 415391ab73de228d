#include "common/files/base64.hpp"

#include <algorithm>

namespace slammot::files {
namespace {

constexpr std::string_view kDigits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

}  // namespace

std::string to_base64(std::span<const std::uint8_t> bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t bits = 0;
    for (std::size_t j = 0; j < 3; ++j) bits = bits << 8 | (j < count ? bytes[i + j] : 0U);
    for (std::size_t j = 0; j < 4; ++j)
      text.push_back(j <= count ? kDigits[bits >> (18 - 6 * j) & 63] : '=');
  }
  return text;
}

std::string to_base64(std::string_view bytes) {
  return to_base64(std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()));
}

std::optional<std::vector<std::uint8_t>> from_base64(std::string_view text) {
  if (text.size() % 4 != 0) return std::nullopt;
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < text.size(); i += 4) {
    std::uint32_t bits = 0;
    std::size_t fill = 0;
    for (std::size_t j = 0; j < 4; ++j) {
      const bool is_fill = text[i + j] == '=' && j >= 2 && i + 4 == text.size();
      const std::size_t digit = is_fill ? 0 : kDigits.find(text[i + j]);
      if (digit == std::string_view::npos || (fill > 0 && !is_fill)) return std::nullopt;
      fill += is_fill ? 1 : 0;
      bits = bits << 6 | static_cast<std::uint32_t>(digit);
    }
    for (std::size_t j = 0; j + fill < 3; ++j)
      bytes.push_back(static_cast<std::uint8_t>(bits >> (16 - 8 * j)));
  }
  return bytes;
}

}  // namespace slammot::files
