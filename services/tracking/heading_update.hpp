#pragma once

#include "services/tracking/observation.hpp"
#include "services/tracking/track.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

// Each function's precondition: the track is a box. time_s: since the last observation.

/// Updates axis and heading by the long visible side, if there is one.
void follow_side(Track& track, const Observation& observation, double time_s,
                 const TrackingConfig& config);

/// Updates the heading by the course, if known. A box that moves backwards or sideways was drawn
/// the wrong way: it is turned.
void follow_course(Track& track, const Observation& observation, double time_s,
                   const TrackingConfig& config);

/// Updates the velocity by the axis of an oriented box: constrain_to_axis().
void follow_axis(Track& track, double time_s, const TrackingConfig& config);

}  // namespace slammot::tracking
