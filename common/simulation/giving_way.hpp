#pragma once

#include <span>
#include <vector>

#include "common/geometry/pose2.hpp"
#include "common/simulation/surface.hpp"

namespace slammot::simulation {

/// A pedestrian, or a round object that stands, as other pedestrians see it.
struct Disc {
  geometry::Vector2 centre_in_world;
  geometry::Vector2 velocity_in_world_mps;
  double radius_m = 0.0;
  bool gives_way = false;  ///< It does half of what avoids a collision.
};

/// Half of the distance that the centres of two pedestrians keep.
constexpr double kPedestrianRadius_m = 0.3;

/// Velocity of a pedestrian, nearest to the preferred one and not faster than it, with which nobody
/// collides within some seconds: optimal reciprocal collision avoidance (van den Berg et al. 2011).
/// Equals the preferred one where nothing is in the way. In a throng that leaves no such velocity,
/// the one that violates all constraints least.
geometry::Vector2 velocity_giving_way(const Disc& self, const geometry::Vector2& preferred_mps,
                                      std::span<const Disc> others, const Outline& stationary,
                                      double dt_s);

}  // namespace slammot::simulation
