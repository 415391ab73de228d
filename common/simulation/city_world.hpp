#pragma once

#include <cstdint>

#include "common/simulation/street_plan.hpp"
#include "common/simulation/surface.hpp"

namespace slammot::simulation {

/// Stationary objects of the city in the world frame: buildings with irregular fronts,
/// parks, trees, lamps, signal poles and parked cars.
Outline build_city(const StreetPlan& plan, std::uint64_t seed);

/// Straight segments with a class each, as in the walls file: round objects become octagons.
std::vector<Segment> true_segments(const Outline& outline_in_world);

}  // namespace slammot::simulation
