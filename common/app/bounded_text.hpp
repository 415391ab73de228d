#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string_view>

namespace slammot::app {

/// Copies text into a bounded string of a bus type, cut off where it does not fit.
template <std::size_t N>
void copy_text(std::string_view text, char (&to)[N]) {
  const std::size_t length = std::min(text.size(), N - 1);
  std::memcpy(to, text.data(), length);
  std::memset(to + length, 0, N - length);
}

}  // namespace slammot::app
