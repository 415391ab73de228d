#pragma once

#include "common/geometry/pose2.hpp"

namespace slammot::geometry {

/// A place on the earth: WGS 84.
struct Geodetic {
  double latitude_deg = 0.0;    ///< North of the equator,
  double longitude_deg = 0.0;   ///< east of Greenwich.
};

/// The place so far east (x) and north (y) of an origin, and back. The earth is taken to be flat around the origin, with its
/// radii of curvature there: within 10 km and below 60 degrees of latitude wrong by under 0.3 m in 1 km, 30 m in 10 km. Not
/// for the poles.
Geodetic geodetic_at(const Geodetic& origin, const Vector2& east_north_m);
Vector2 east_north_m(const Geodetic& origin, const Geodetic& place);

}  // namespace slammot::geometry
