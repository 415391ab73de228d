#include "common/simulation/moving_object.hpp"

#include <cmath>

namespace slammot::simulation {
namespace {

using geometry::Vector2;

void add_box(Outline& outline, double centre_x_m, double length_m, double width_m,
             double corner_m) {
  std::vector<Vector2> corners = cut_rectangle(length_m, width_m, corner_m);
  for (Vector2& corner : corners) corner.x() += centre_x_m;
  add_polygon(outline, corners, Material::body);
}

}  // namespace

std::string_view name(ObjectClass kind) {
  switch (kind) {
    case ObjectClass::car: return "car";
    case ObjectClass::truck: return "truck";
    case ObjectClass::bus: return "bus";
    case ObjectClass::bicycle: return "bicycle";
    case ObjectClass::pedestrian: break;
  }
  return "pedestrian";
}

BoxSize usual_size(ObjectClass kind) {
  switch (kind) {
    case ObjectClass::car: return {4.4, 1.8};
    case ObjectClass::truck: return {7.1, 2.4};
    case ObjectClass::bus: return {12.0, 2.5};
    case ObjectClass::bicycle: return {1.6, 0.6};
    case ObjectClass::pedestrian: break;
  }
  return {0.35, 0.5};
}

double usual_height_m(ObjectClass kind) {
  switch (kind) {
    case ObjectClass::car: return 1.45;
    case ObjectClass::truck: return 3.4;
    case ObjectClass::bus: return 3.1;
    case ObjectClass::bicycle:
    case ObjectClass::pedestrian: break;
  }
  return 1.75;
}

Outline vehicle_outline(ObjectClass kind, const BoxSize& size) {
  Outline outline;
  const double front_m = 0.5 * size.length_m;
  if (kind == ObjectClass::truck) {
    const double cab_m = 0.28 * size.length_m;
    add_box(outline, front_m - 0.5 * cab_m, cab_m, size.width_m, 0.2);
    add_box(outline, -front_m + 0.22 * size.length_m, 0.16 * size.length_m, size.width_m,
            0.1);                                               // rear axle
    add_box(outline, -front_m + 0.1, 0.2, size.width_m, 0.05);  // tail bar
    add_box(outline, 0.0, 0.8 * size.length_m, 0.9, 0.1);       // frame between
  } else if (kind == ObjectClass::bicycle) {
    add_box(outline, 0.0, size.length_m, 0.08, 0.03);
    outline.circles.push_back({{0.0, 0.13}, 0.08, Material::body});
    outline.circles.push_back({{0.1, -0.13}, 0.08, Material::body});
  } else {
    add_box(outline, 0.0, size.length_m, size.width_m, kind == ObjectClass::bus ? 0.15 : 0.35);
  }
  return outline;
}

Outline pedestrian_outline(double phase_rad, double step_m) {
  constexpr double kLegRadius_m = 0.075;
  constexpr double kHalfHip_m = 0.12;
  const double swing_m = 0.5 * step_m * std::sin(phase_rad);
  Outline outline;
  outline.circles.push_back({{swing_m, kHalfHip_m}, kLegRadius_m, Material::body});
  outline.circles.push_back({{-swing_m, -kHalfHip_m}, kLegRadius_m, Material::body});
  return outline;
}

}  // namespace slammot::simulation
