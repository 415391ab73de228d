#pragma once

#include "services/tracking/track.hpp"

namespace slammot::tracking {

/// Whether the track is drawn of the same thing as the other, or of nothing, and the other is worth more: who is known to walk than a
/// vehicle around them, what has the echoes than what has crumbs of them, what is drawn right, what is confirmed, what is older.
bool is_duplicate(const Track& track, const Track& other, const TrackingConfig& config);

/// Whether two that are long known drive alike, and are so near to each other that they fit into one car, or, where their bodies
/// overlap, into one truck.
bool are_parts_of_one_vehicle(const Track& a, const Track& b, const TrackingConfig& config);

}  // namespace slammot::tracking
