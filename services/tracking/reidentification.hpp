#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "services/tracking/track.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// Log-likelihood ratio: `found` is the object of the track `lost`, which has had no echo since,
/// against a new object. Compares position, velocity and class; both states at the same time.
/// -infinity where the two differ by more than their covariances allow.
double log_odds_of_same_object(const Track& lost, const Track& found, const TrackingConfig& config);

/// The track that lost its object behind another, and whose object `found` is, about to be
/// published for the first time; none where a new object is likelier.
std::optional<std::size_t> track_of_same_object(const Track& found, std::span<const Track> tracks,
                                                const TrackingConfig& config);

/// Gives `found` the identity and the history of the lost track, which is marked for removal.
void continue_track(Track& lost, Track& found);

}  // namespace slammot::tracking
