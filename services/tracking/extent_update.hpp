#pragma once

#include "services/tracking/observation.hpp"
#include "services/tracking/track.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// Replaces the outline by a box. The visible sides stay in place: the centre moves, the velocity
/// does not.
void redraw(Track& track, const Box& box, const Observation& observation,
            const TrackingConfig& config);

/// Turns the box and keeps its visible part in place. Turned about its centre, a long box of which
/// one end is visible would seem to move sideways, and the course and the heading would follow.
/// Precondition: the track is a box.
void turn(Track& track, double by_rad, const Observation& observation,
          const TrackingConfig& config);

/// Box around the echoes, along the course where that is known.
Box box_along_course(const Track& track, const Observation& observation,
                     const TrackingConfig& config);

/// Turns a blob that has become large into a box. A known pedestrian stays a blob.
void become_box_if_large(Track& track, const Observation& observation,
                         const TrackingConfig& config);

/// Exchanges length and width of a box that is not oriented if its width exceeds every front and
/// the exchange fits road users much better. Precondition: the track is a box.
void exchange_sides_if_likelier(Track& track, const Observation& observation,
                                const TrackingConfig& config);

/// Replaces the extent by a box around these echoes: what was followed was a part of the object.
/// The velocity stays.
void reinitialise_extent(Track& track, const Observation& observation,
                         const TrackingConfig& config);

/// The same for a tentative track that only the fit of its extent has kept from being confirmed for
/// a while: a dark object is initiated around a few stray echoes and never leaves that extent by
/// itself; docs/decisions/existence-and-publication.md.
void reinitialise_extent_if_misfit(Track& track, const Observation& observation, double time_s,
                                   const TrackingConfig& config);

}  // namespace slammot::tracking
