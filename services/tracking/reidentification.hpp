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

/// True for an unpublished track with evidence enough to be compared with hidden ones: it surely
/// moves. That a hidden object is expected there takes the place of what confirmation asks besides.
bool may_have_returned(const Track& track, const TrackingConfig& config);

/// The track that lost its object behind another, and whose object `found` is, which was not
/// published yet; none where a new object is likelier, or, of a tentative track, a stationary one.
std::optional<std::size_t> track_of_same_object(const Track& found, std::span<const Track> tracks,
                                                const TrackingConfig& config);

/// Gives `found` the identity and the history of the lost track, which is marked for removal, and
/// fuses its state with the prediction of the lost one.
void continue_track(Track& lost, Track& found, const TrackingConfig& config);

}  // namespace slammot::tracking
