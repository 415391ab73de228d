#include "common/simulation/surface.hpp"

#include <cmath>
#include <limits>

namespace slammot::simulation {
namespace {

using geometry::cross;
using geometry::Vector2;
constexpr double kMiss = std::numeric_limits<double>::infinity();

}  // namespace

double usual_height_m(Material material) {
  switch (material) {
    case Material::wall: return 12.0;
    case Material::parked_car: return 1.45;
    case Material::post: return 5.0;
    case Material::foliage: return 2.2;
    case Material::ground: return 0.0;
    case Material::body: break;
  }
  return 1.5;
}

void add_polygon(Outline& outline, const std::vector<Vector2>& corners, Material material) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    outline.segments.push_back({corners[i], corners[(i + 1) % corners.size()], material});
  }
}

std::vector<Vector2> cut_rectangle(double length_m, double width_m, double corner_m) {
  const double x = 0.5 * length_m;
  const double y = 0.5 * width_m;
  const double c = corner_m;
  return {{x, y - c},   {x - c, y},   {-x + c, y}, {-x, y - c},
          {-x, -y + c}, {-x + c, -y}, {x - c, -y}, {x, -y + c}};
}

double distance_along_ray(const Segment& segment, const Vector2& origin, const Vector2& direction) {
  const Vector2 along = segment.b - segment.a;
  const Vector2 to_a = segment.a - origin;
  const double denominator = cross(direction, along);
  if (denominator == 0.0) return kMiss;  // a surface seen exactly edge-on returns nothing
  const double range_m = cross(to_a, along) / denominator;
  const double fraction = cross(to_a, direction) / denominator;
  return range_m >= 0.0 && fraction >= 0.0 && fraction <= 1.0 ? range_m : kMiss;
}

double distance_along_ray(const Circle& circle, const Vector2& origin, const Vector2& direction) {
  const Vector2 to_centre = circle.centre - origin;
  const double along_m = to_centre.dot(direction);
  const double root =
      circle.radius_m * circle.radius_m - (to_centre.squaredNorm() - along_m * along_m);
  if (root < 0.0) return kMiss;
  const double range_m = along_m - std::sqrt(root);
  return range_m >= 0.0 ? range_m : kMiss;
}

}  // namespace slammot::simulation
