#pragma once

#include "services/tracking/track.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// Least log-odds of existence of a confirmable track.
inline constexpr double kConfirmScore = 2.0;
/// Faded votes that it moved: so many suffice with a significant distance,
inline constexpr double kLeastMovedVotes = 6.0;
/// and so many without one. All limits: docs/decisions/existence-and-publication.md.
inline constexpr double kSureMovedVotes = 30.0;

/// True if the evidence suffices to publish the track as an object that moves.
bool is_confirmable(const Track& track, const TrackingConfig& config);

/// True if only the distance of its echoes from its sides keeps the track from being confirmable;
/// docs/decisions/existence-and-publication.md.
bool misfits_only(const Track& track, const TrackingConfig& config);

/// True if the object has been in space that the map knows to be free ever since its first
/// observation, and hardly any echo comes from where an earlier scan had one: it has come there,
/// even if the earlier scans did not see the place. Needs three echoes; false where only people
/// move.
bool appeared_in_free_space(const Track& track, const TrackingConfig& config);

/// True for a box whose echoes neither lie on its sides nor come from where it was predicted.
bool is_inconsistent(const Track& track, const TrackingConfig& config);

/// The inconsistent one of two boxes if the other is consistent, else null.
const Track* inconsistent_one(const Track& a, const Track& b, const TrackingConfig& config);

/// True if the speed differs from zero by kDetectionSigmas; less for pedestrians.
bool is_surely_fast(const Track& track);

/// True if the object is elsewhere than at its birth.
bool has_travelled(const Track& track, const TrackingConfig& config);

}  // namespace slammot::tracking
