#pragma once

#include <chrono>
#include <cstdint>

namespace slammot::localization {

/// Time of a clock that never goes back.
inline std::int64_t monotonic_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace slammot::localization
