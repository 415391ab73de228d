#pragma once

#include <cstdint>

#include "common/flow/tracked_objects.hpp"
#include "services/tracking/track.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// True if the track is published as confirmed at this stamp: confirmed, seen now, with a
/// known velocity that nothing contradicts.
bool is_published(const Track& track, std::int64_t stamp_ns, const TrackingConfig& config);

/// True if a track that is_published() refuses is published as occluded at this stamp: it was
/// published for a while, probably exists, and its position is known to a few metres. Its echoes,
/// if there are any, may be another object's.
bool is_published_as_occluded(const Track& track, std::int64_t stamp_ns,
                              const TrackingConfig& config);

/// Writes the track as it is published at this stamp. All members of the object are overwritten.
void publish(const Track& track, std::int64_t stamp_ns, const TrackingConfig& config,
             flow::TrackedObject& object);

/// The same as a value.
flow::TrackedObject published(const Track& track, std::int64_t stamp_ns,
                              const TrackingConfig& config);

}  // namespace slammot::tracking
