#pragma once

#include <optional>

#include "services/loop_closing/candidates.hpp"

namespace slammot::loop_closing {

/// A place that is no longer needed because many others show the same surroundings, from before and
/// from after it: the vehicle has been here often. The first ones anchor the map and the latest
/// ones show what it looks like now. None where there are few. `newest`: around which to look.
std::optional<flow::SubmapId> superseded_place(const SubmapView& submaps, const Place& newest);

}  // namespace slammot::loop_closing
