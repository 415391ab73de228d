#pragma once

#include "common/geometry/pose2.hpp"

namespace slammot::matching {

/// A point of the scan with its standard deviation across the surface.
struct MatchPoint {
  geometry::Vector2 in_base_m;
  double sigma_m = 0.03;
};

}  // namespace slammot::matching
