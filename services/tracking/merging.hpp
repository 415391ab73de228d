#pragma once

#include <cstdint>
#include <vector>

#include "services/tracking/associations.hpp"
#include "services/tracking/scan_context.hpp"
#include "services/tracking/track.hpp"

namespace slammot::tracking {

/// True if `track` duplicates `other` and ranks below it. Rank: a vehicle over its parts, a known
/// pedestrian over the vehicle box around them, more echoes, a consistent extent, confirmed, older.
bool is_duplicate(const Track& track, const Track& other, const TrackingConfig& config);

/// True if two tracks move alike and fit into one car or, where their boxes overlap, into one
/// truck.
bool are_parts_of_one_vehicle(const Track& a, const Track& b, const TrackingConfig& config);

/// Joins long known tracks that are the two ends of one vehicle, between which no beam passes: its
/// middle is hidden or dark. Absorbed tracks have no hits left. Returns their number.
std::uint64_t join_parts(std::vector<Track>& tracks, Associations& associations,
                         const ScanContext& context);

/// The same for duplicates.
std::uint64_t merge_duplicates(std::vector<Track>& tracks, Associations& associations,
                               const TrackingConfig& config);

}  // namespace slammot::tracking
