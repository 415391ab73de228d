#pragma once

#include <cstdint>

#include "services/tracking/track.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// Log-odds of existence below which a track ends.
inline constexpr double kRejectScore = -3.0;

/// True if a tentative track has not been confirmed within its time. One that has travelled and is
/// surely fast lacks only votes or a better known speed: it has twice the time.
bool is_timed_out(const Track& track, double age_s, const TrackingConfig& config);

/// True if the track has claimed to move far without progress: a stationary object of which now
/// this, now that part is seen.
bool claims_motion_without_travel(const Track& track, const TrackingConfig& config);

/// True if a confirmed track has stood, or gone unseen, for longer than the distance it has
/// travelled justifies. A vehicle that has travelled least_travel_to_stand_m may stand for as long
/// as it is seen.
bool has_stood_too_long(const Track& track, std::int64_t stamp_ns, const TrackingConfig& config);

/// True if the track ends at this stamp: unseen, timed out, held never to have moved, or rejected
/// by its score.
bool has_ended(const Track& track, std::int64_t stamp_ns, const TrackingConfig& config);

}  // namespace slammot::tracking
