#pragma once

#include "services/loop_closing/candidates.hpp"

namespace slammot::loop_closing {

/// True if `source`, after registration, has walls in free space of the target or the reverse.
bool contradicts(const SubmapView& submaps, flow::SubmapId target, const Place& source);

/// True if at least half of the submaps just before `located` contradict the map at the poses
/// that the graph gives them.
bool preceding_submaps_contradict(const SubmapView& submaps, flow::SubmapId located);

}  // namespace slammot::loop_closing
