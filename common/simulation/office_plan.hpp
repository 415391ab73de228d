#pragma once

#include <cstdint>
#include <vector>

#include "common/simulation/surface.hpp"
#include "common/simulation/walkers.hpp"

namespace slammot::simulation {

/// A floor: a ring of corridors with corridors across it, rooms on both sides of each.
struct OfficeConfig {
  double length_m = 46.0;  ///< Of the ring, along x, between the middles of its corridors.
  double depth_m = 27.0;
  int cross_corridors = 1;
  double corridor_m = 2.2;  ///< Width.
  double open_door_share = 0.45;
  double furniture_share = 0.7;  ///< Of the places along a room's walls.
  double corridor_furniture_per_m = 0.06;
};

/// Corner or crossing of corridors. Column counts the corridors across, the ring's own two ends
/// included; row is 0 in the southern and 1 in the northern corridor.
struct OfficeCorner {
  int column = 0;
  int row = 0;
};

struct OfficePlan {
  Outline outline_in_world;
  WalkGraph corridors;
  std::vector<double> columns_m;  ///< x of the corridors that run north.
  double depth_m = 0.0;

  geometry::Vector2 corner_in_world(const OfficeCorner& corner) const;
};

/// Walls have two faces, doors stand open or are closed in a shallow recess, rooms are furnished.
OfficePlan build_office(const OfficeConfig& config, std::uint64_t seed);

}  // namespace slammot::simulation
