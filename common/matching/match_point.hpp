#pragma once

#include "common/geometry/pose2.hpp"

namespace slammot::matching {

/// A point of the scan.
struct MatchPoint {
  geometry::Vector2 in_base_m;
  double sigma_m = 0.03;        ///< Standard deviation across the surface.
  double object_width_m = 0.0;  ///< Of a narrow object of which both ends were seen; else 0.
  double object_points = 0.0;   ///< Echoes of that object in the scan.
};

}  // namespace slammot::matching
