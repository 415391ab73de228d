#pragma once

#include <string>
#include <vector>

#include "common/geometry/geodetic.hpp"
#include "common/geometry/pose2.hpp"

namespace slammot::streets {

/// Centre line of a street, in the frame `streets`: metres, x to the east and y to the north of the
/// graph's origin.
struct Street {
  std::string name;
  std::vector<geometry::Vector2> line_m;  ///< At least two points.
};

/// A straight part of a street.
struct Segment {
  geometry::Vector2 from_m;
  geometry::Vector2 to_m;

  double length_m() const { return (to_m - from_m).norm(); }
  double direction_rad() const;
  geometry::Vector2 nearest_to(const geometry::Vector2& point_m) const;
};

/// Streets of a digital map: OpenStreetMap or GeoJSON.
struct StreetGraph {
  geometry::Geodetic origin;
  std::vector<Street> streets;

  /// All straight parts that are longer than a millimetre.
  std::vector<Segment> segments() const;
  double length_m() const;
  /// Distance of a point from the nearest street; infinite without streets.
  double distance_m(const geometry::Vector2& point_m) const;
};

}  // namespace slammot::streets
