#pragma once

#include "common/filters/imm.hpp"
#include "services/tracking/track.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// Extent and motion of a track.
struct Belief {
  Outline outline;
  filters::ImmState mixture;
  filters::MotionState estimate;
  Consistency consistency = {};  ///< Empty after refiltering: no prediction has been compared with
                                 ///< an observation.
};

Belief belief_of(const Track& track);

/// Filters the stored observations of a tentative box again, with the box as it is known now:
/// observations of a part, or by another box, moved as that did. Takes the box as it lies or turned
/// by a quarter, whichever is likelier by the sizes of road users and by a course along the length.
/// A blob is returned unchanged. Cost: 2 x 40 filter cycles, a few times a track. Allocates
/// nothing.
Belief refiltered(const Track& track, const TrackingConfig& config);

/// Replaces extent and motion; no mode is a turn. The place of birth moves with the centre.
void set_belief(Track& track, const Belief& belief);

}  // namespace slammot::tracking
