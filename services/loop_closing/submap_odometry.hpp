#pragma once

#include "common/flow/graph_correction.hpp"
#include "common/flow/submap.hpp"
#include "services/loop_closing/place.hpp"

namespace slammot::loop_closing {

/// True if every number that the graph uses is finite.
bool is_sound(const flow::Submap& submap);

/// True if odometry does not determine even the heading relative to the submap before. Such a
/// submap begins an island.
bool begins_island(const flow::Submap& submap);

/// Odometric constraint from the last submap to a new one. If submaps between both are missing, the
/// mean is from their poses in odom. The covariance has a floor, so that it can be inverted.
flow::Constraint odometric_constraint(const Place& previous, const flow::Submap& submap);

}  // namespace slammot::loop_closing
