#pragma once

#include <cstddef>
#include <limits>

namespace slammot::association {

/// Cost of a pair that is not allowed.
inline constexpr double kForbidden = std::numeric_limits<double>::infinity();
inline constexpr std::size_t kUnassigned = std::numeric_limits<std::size_t>::max();

}  // namespace slammot::association
