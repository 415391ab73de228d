#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/pose2.hpp"

namespace slammot::simulation {

/// Material of a surface. The numbers of the first three are the classes of the walls file.
enum class Material : std::uint8_t { wall = 0, parked_car = 1, post = 2, foliage, ground, body };

/// Height of the top of this material above the road; for a moving body its class is more accurate.
double usual_height_m(Material material);

/// Straight segment of a surface, in the frame of its object.
struct Segment {
  geometry::Vector2 a;
  geometry::Vector2 b;
  Material material = Material::wall;
};

/// Round surface: trunk, pole, bush, leg.
struct Circle {
  geometry::Vector2 centre;
  double radius_m = 0.0;
  Material material = Material::post;
};

/// Cross-section of an object at the scanner's height, in the frame named by the variable.
struct Outline {
  std::vector<Segment> segments;
  std::vector<Circle> circles;
};

/// Adds a closed polygon's edges.
void add_polygon(Outline& outline, const std::vector<geometry::Vector2>& corners,
                 Material material);

/// Rectangle centred at the origin with its corners cut off by corner_m.
std::vector<geometry::Vector2> cut_rectangle(double length_m, double width_m, double corner_m);

/// Distance along a ray to a surface, unit direction; infinity where the ray misses it or starts
/// beyond it.
double distance_along_ray(const Segment& segment, const geometry::Vector2& origin,
                          const geometry::Vector2& direction);
double distance_along_ray(const Circle& circle, const geometry::Vector2& origin,
                          const geometry::Vector2& direction);

}  // namespace slammot::simulation
