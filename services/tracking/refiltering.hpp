#pragma once

#include "common/filters/imm.hpp"
#include "services/tracking/body.hpp"
#include "services/tracking/track.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// What is believed of a body and its motion.
struct Belief {
  Body body;
  filters::ImmState motion;
  filters::MotionState estimate;
  Consistency consistency = {};  ///< None of what was filtered again: what it predicted was held against nothing.
};

/// As it is believed now.
Belief belief(const Track& track);

/// The life of a track that has sides, as all that was kept of it tells when filtered again, by the body as it is known now: what was
/// measured of a piece of it, or of a body that was drawn otherwise, went as that did, and not as the body. The body lies as it
/// does or is turned by a quarter, whichever is likelier, by how well the sizes fit the kinds of road users and by that a body
/// goes along its length. Cost: 2 x 40 cycles of the filters, once a track or a few times. Allocates nothing.
Belief refiltered(const Track& track, const TrackingConfig& config);

/// Gives the track this life, of which no mode is a turn. Where it began moves as its centre does.
void set_belief(Track& track, const Belief& belief);

}  // namespace slammot::tracking
