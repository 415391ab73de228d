#pragma once

#include "common/geometry/pose2.hpp"

namespace slammot::geometry {

/// Geodetic position in WGS 84.
struct Geodetic {
  double latitude_deg = 0.0;   ///< North of the equator,
  double longitude_deg = 0.0;  ///< east of Greenwich.
};

/// Position at an offset east (x) and north (y) of an origin, and the inverse. Uses the earth's
/// radii of curvature at the origin. Within 10 km and below 60 degrees of latitude the error is
/// under 0.3 m at 1 km and 30 m at 10 km. Invalid at the poles.
Geodetic geodetic_at(const Geodetic& origin, const Vector2& east_north_m);
Vector2 east_north_m(const Geodetic& origin, const Geodetic& place);

}  // namespace slammot::geometry
