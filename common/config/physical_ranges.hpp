#pragma once

#include "common/config/fields.hpp"

namespace slammot::config {

/// Limits of settings with units: no scanner looks farther than a kilometre, and nothing on a road
/// is as fast as one a second. Grids and gates of this size are computed without overflow.
inline constexpr Range kLength_m{kPositive.lowest, 1000.0};
inline constexpr Range kLengthOrZero_m{0.0, 1000.0};
inline constexpr Range kSpeed_mps{kPositive.lowest, 1000.0};
inline constexpr Range kSpeedOrZero_mps{0.0, 1000.0};

}  // namespace slammot::config
