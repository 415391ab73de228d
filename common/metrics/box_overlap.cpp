#include "common/metrics/box_overlap.hpp"

#include <array>

namespace slammot::metrics {
namespace {

using geometry::cross;
using geometry::Vector2;
using Polygon = std::vector<Vector2>;

/// Counter-clockwise.
Polygon corners_of(const Box& box) {
  const double x_m = 0.5 * box.length_m;
  const double y_m = 0.5 * box.width_m;
  Polygon corners;
  for (const Vector2& corner :
       std::array<Vector2, 4>{{{x_m, y_m}, {-x_m, y_m}, {-x_m, -y_m}, {x_m, -y_m}}})
    corners.push_back(box.world_from_box * corner);
  return corners;
}

/// The part to the left of the line through a and b: Sutherland and Hodgman 1974.
Polygon clipped(const Polygon& polygon, const Vector2& a, const Vector2& b) {
  Polygon left;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2& from = polygon[i];
    const Vector2& to = polygon[(i + 1) % polygon.size()];
    const double from_side = cross(b - a, from - a);
    const double to_side = cross(b - a, to - a);
    if (from_side >= 0.0) left.push_back(from);
    if ((from_side < 0.0) != (to_side < 0.0))
      left.push_back(from + from_side / (from_side - to_side) * (to - from));
  }
  return left;
}

double area_m2(const Polygon& polygon) {
  double twice_m2 = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    twice_m2 += cross(polygon[i] - polygon[0], polygon[(i + 1) % polygon.size()] - polygon[0]);
  return 0.5 * twice_m2;
}

}  // namespace

Box box_of(const TrueObject& object) {
  return {object.world_from_object, object.length_m, object.width_m};
}

Box box_of(const ReportedTrack& track) {
  return {track.world_from_object, track.length_m, track.width_m};
}

double intersection_over_union(const Box& a, const Box& b) {
  const double a_m2 = a.length_m * a.width_m;
  const double b_m2 = b.length_m * b.width_m;
  if (!(a_m2 > 0.0 && b_m2 > 0.0)) return 0.0;
  Polygon common = corners_of(a);
  const Polygon limits = corners_of(b);
  for (std::size_t i = 0; i < limits.size() && !common.empty(); ++i)
    common = clipped(common, limits[i], limits[(i + 1) % limits.size()]);
  const double common_m2 = common.empty() ? 0.0 : area_m2(common);
  return common_m2 / (a_m2 + b_m2 - common_m2);
}

}  // namespace slammot::metrics
