#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>

namespace slammot::geometry {

/// True if directions at this spacing cover the full circle, so that the first and the last are
/// neighbours. One may be missing.
inline bool goes_all_round(std::size_t directions, double step_rad) {
  return directions > 1 &&
         static_cast<double>(directions + 1) * std::abs(step_rad) > 2.0 * std::numbers::pi;
}

}  // namespace slammot::geometry
