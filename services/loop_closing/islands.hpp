#pragma once

#include <map>
#include <span>
#include <vector>

#include "common/flow/graph_correction.hpp"

namespace slammot::loop_closing {

/// For every submap the earliest one that constraints tie it to, itself where none does: two with
/// the same answer are on one island. Where islands lie to each other nobody knows until a revisit
/// joins them.
std::map<flow::SubmapId, flow::SubmapId> islands(const std::vector<flow::CorrectedSubmap>& submaps,
                                                 std::span<const flow::Constraint> constraints);

}  // namespace slammot::loop_closing
