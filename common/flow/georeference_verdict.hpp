#pragma once

#include <cmath>

#include "common/flow/absolute_measurements.hpp"

namespace slammot::flow {

/// Largest bias of a compass that is used. An uncalibrated compass errs by some degrees, and the
/// declination of most inhabited places is below 20 degrees: more is a mounting that nobody stated,
/// or GNSS that is wrong.
inline constexpr double kMostCompassBias_rad = 0.35;

/// True if fixes were compared with the map and their error is absurd: they are not used.
inline bool gnss_contradicts_map(const Georeference& georeference) {
  return !georeference.has_position && georeference.fix_sigma_m > 0.0;
}

/// True if the compass contradicts GNSS, which agrees with the map: it is not used.
inline bool compass_contradicts_gnss(const Georeference& georeference) {
  return georeference.has_position &&
         std::abs(georeference.compass_bias_rad) > kMostCompassBias_rad;
}

}  // namespace slammot::flow
