#pragma once

#include "services/tracking/road_users.hpp"
#include "services/tracking/track.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// Adds what an ended track tells of the road users of this place: sizes of an oriented box where they are well known, the distance of the
/// echoes from the sides of a vehicle, and the gait of a pedestrian, each if it was followed for long enough.
void learn_from(RoadUsersSeen& seen, const Track& track, const TrackingConfig& config);

void learn_sizes(RoadUsersSeen& seen, const Track& track, const TrackingConfig& config);
void learn_outline_error(RoadUsersSeen& seen, const Track& track, const TrackingConfig& config);
void learn_gait(RoadUsersSeen& seen, const Track& track, const TrackingConfig& config);

}  // namespace slammot::tracking
