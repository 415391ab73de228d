#pragma once

#include <map>
#include <span>
#include <vector>

#include "common/flow/graph_correction.hpp"

namespace slammot::loop_closing {

/// Connected components of the pose graph: for each submap, the earliest submap that constraints
/// connect it to, or itself. Two submaps with the same value are on one island. Relative poses of
/// different islands are unknown until a closure joins them.
std::map<flow::SubmapId, flow::SubmapId> islands(const std::vector<flow::CorrectedSubmap>& submaps,
                                                 std::span<const flow::Constraint> constraints);

}  // namespace slammot::loop_closing
