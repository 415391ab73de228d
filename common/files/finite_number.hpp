#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace slammot::files {

/// The number that the whole text is; none for anything else, and for infinity and NaN.
inline std::optional<double> finite_number(std::string_view text) {
  double value = 0.0;
  const auto [end, fault] = std::from_chars(text.begin(), text.end(), value);
  const bool is_number = fault == std::errc() && end == text.end() && std::isfinite(value);
  return is_number ? std::optional(value) : std::nullopt;
}

}  // namespace slammot::files
