#pragma once

#include "common/metrics/scene.hpp"

namespace slammot::metrics {

/// A rectangle in world.
struct Box {
  geometry::Pose2 world_from_box;  ///< Its centre, x along its length.
  double length_m = 0.0;
  double width_m = 0.0;
};

Box box_of(const TrueObject& object);
Box box_of(const ReportedTrack& track);

/// Area of the intersection over that of the union, in [0, 1]; 0 if a box has no area.
double intersection_over_union(const Box& a, const Box& b);

}  // namespace slammot::metrics
