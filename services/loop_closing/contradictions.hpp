#pragma once

#include "services/loop_closing/candidates.hpp"

namespace slammot::loop_closing {

/// Agreement of the walls of `source` and of the target at the pose that the graph gives them,
/// after registration.
Agreement agreement_on(const SubmapView& submaps, flow::SubmapId target, const Place& source);

/// True if both have seen enough of each other's walls.
bool is_comparable(const Agreement& agreement);

/// True if it is comparable, and walls of one are in free space of the other.
bool contradicts(const Agreement& agreement);

/// True if `source`, after registration, has walls in free space of the target or the reverse.
bool contradicts(const SubmapView& submaps, flow::SubmapId target, const Place& source);

/// True if at least half of the submaps just before `located` contradict the map at the poses
/// that the graph gives them.
bool preceding_submaps_contradict(const SubmapView& submaps, flow::SubmapId located);

}  // namespace slammot::loop_closing
