#pragma once

#include <chrono>
#include <cstdint>

namespace slammot::app {

/// Nanoseconds since 1970 (UTC): time that others can compare with theirs. It may be set back.
inline std::int64_t system_clock_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace slammot::app
