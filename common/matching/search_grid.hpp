#pragma once

#include <cmath>
#include <cstdint>

namespace slammot::matching {

/// Steps on either side of a window's middle that cover it.
inline std::int32_t steps_within(double half_width, double step) {
  return static_cast<std::int32_t>(std::ceil(half_width / step - 1e-9));
}

/// Coarsest level of a branch-and-bound search, with blocks of 2^level cells a side, that covers
/// the window in few blocks and whose bounds are still useful.
inline int useful_level(std::int32_t half_width_cells) {
  constexpr int kHighest = 6;  // beyond 64 cells a maximum is too loose a bound
  int level = 0;
  while (level < kHighest && (1 << (level + 1)) <= half_width_cells + 1) ++level;
  return level;
}

}  // namespace slammot::matching
