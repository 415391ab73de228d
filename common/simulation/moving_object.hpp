#pragma once

#include <string_view>

#include "common/simulation/surface.hpp"

namespace slammot::simulation {

enum class ObjectClass { car, truck, bus, bicycle, pedestrian };

/// As the objects file names it.
std::string_view name(ObjectClass kind);

/// Box around the whole object: x forward.
struct BoxSize {
  double length_m = 0.0;
  double width_m = 0.0;
};

/// Of its class; cars differ around it.
BoxSize usual_size(ObjectClass kind);

double usual_height_m(ObjectClass kind);

/// An object that can move. world_from_object is at the centre of its box, x forward.
struct MovingObject {
  int id = 0;
  ObjectClass kind = ObjectClass::car;
  BoxSize size;
  geometry::Pose2 world_from_object;
  double speed_mps = 0.0;
  Outline outline_in_object;  ///< Visible outline at bumper height.
};

/// What a scanner 0.6 m above the road sees: a car's whole side; of a truck cab, axles and tail,
/// apart from each other; of a bicycle its frame and the rider's legs.
Outline vehicle_outline(ObjectClass kind, const BoxSize& size);

inline constexpr double kPedestrianStride_m = 1.45;  ///< Two steps at normal speed.
inline constexpr double kPedestrianStep_m = 0.55;    ///< Between the feet when furthest apart.

/// Two legs. phase_rad runs through one full stride (two steps) in 2 pi; step_m is the distance
/// between the feet when furthest apart.
Outline pedestrian_outline(double phase_rad, double step_m);

}  // namespace slammot::simulation
