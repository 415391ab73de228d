#pragma once

#include "services/tracking/observation.hpp"
#include "services/tracking/scan_context.hpp"
#include "services/tracking/track.hpp"

namespace slammot::tracking {

/// Compares the velocity of a track that is young, or whose velocity is known again, with what
/// earlier scans saw. Ends that come into view, echoes taken by another track, or those of another
/// vehicle passing where this one was hidden, make an object seem fast. Where earlier scans tell
/// the speed the motion is restarted with it; where they only contradict it the velocity is marked
/// as refuted.
void check_velocity(Track& track, const Observation& observation, const ScanContext& context);

}  // namespace slammot::tracking
