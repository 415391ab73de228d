#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

namespace slammot::wire {

/// Longest vehicle, scanner, service and instance name, in bytes.
inline constexpr std::size_t kLongestName = 32;

/// Text of a fixed-size string of a generated struct.
template <std::size_t kSize>
std::string_view text(const char (&field)[kSize]) {
  return {field, static_cast<std::size_t>(std::find(field, field + kSize, '\0') - field)};
}

/// Fills a fixed-size string of a generated struct; what does not fit is cut off.
template <std::size_t kSize>
void set_text(char (&field)[kSize], std::string_view value) {
  const std::size_t length = std::min(value.size(), kSize - 1);
  std::copy_n(value.data(), length, field);
  std::fill(field + length, field + kSize, '\0');
}

/// Whether a sample of any topic is about this vehicle.
template <typename Sample>
bool is_about(const Sample& sample, std::string_view vehicle_id) {
  return text(sample.vehicle_id) == vehicle_id;
}

}  // namespace slammot::wire
