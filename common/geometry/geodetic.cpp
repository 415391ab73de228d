#include "common/geometry/geodetic.hpp"

#include <cmath>
#include <numbers>

namespace slammot::geometry {
namespace {

constexpr double kSemiMajorM = 6378137.0;
constexpr double kEccentricitySquared = 6.69437999014e-3;
constexpr double kRadPerDeg = std::numbers::pi / 180.0;

/// Metres for a degree of longitude (x) and of latitude (y).
Vector2 metres_per_degree(double latitude_deg) {
  const double sine = std::sin(latitude_deg * kRadPerDeg);
  const double shape = 1.0 - kEccentricitySquared * sine * sine;
  const double across_m = kSemiMajorM / std::sqrt(shape);
  const double along_m = across_m * (1.0 - kEccentricitySquared) / shape;
  return {across_m * std::cos(latitude_deg * kRadPerDeg) * kRadPerDeg, along_m * kRadPerDeg};
}

}  // namespace

Geodetic geodetic_at(const Geodetic& origin, const Vector2& east_north_m) {
  const Vector2 scale = metres_per_degree(origin.latitude_deg);
  return {origin.latitude_deg + east_north_m.y() / scale.y(),
          origin.longitude_deg + east_north_m.x() / scale.x()};
}

Vector2 east_north_m(const Geodetic& origin, const Geodetic& place) {
  const Vector2 scale = metres_per_degree(origin.latitude_deg);
  return {(place.longitude_deg - origin.longitude_deg) * scale.x(),
          (place.latitude_deg - origin.latitude_deg) * scale.y()};
}

}  // namespace slammot::geometry
