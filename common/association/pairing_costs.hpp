#pragma once

#include <cstddef>
#include <limits>

namespace slammot::association {

/// Marks a pair that must not be made.
inline constexpr double kForbidden = std::numeric_limits<double>::infinity();
inline constexpr std::size_t kUnassigned = std::numeric_limits<std::size_t>::max();

}  // namespace slammot::association
