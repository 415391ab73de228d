#pragma once

#include "common/flow/tracked_objects.hpp"
#include "services/tracking/extent.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// What the speeds of an object have said of its class so far. Speeds of neighbouring scans are one and the same evidence:
/// they count by the time for which they were held, and older ones fade, since whoever creeps in a queue goes on creeping.
struct SpeedsSeen {
  flow::ClassProbabilities log_likelihood = {};
  double surely_mps = 0.0;  ///< It has been as fast as this for a while, which does not fade.
};

/// Class of an object: pedestrian, bicycle, car, truck or bus.
/// Invariant: `likeliest` is that of likeliest_class(probability), as of the last update.
struct Classification {
  flow::ObjectClass likeliest = flow::ObjectClass::kUnknown;
  flow::ClassProbabilities probability = {};
  SpeedsSeen speeds;                         ///< Since confirmation.
};

/// An estimate of the speed, held for some time.
struct SpeedHeld {
  double speed_mps = 0.0;
  double sigma_mps = 0.0;
  double time_s = 0.0;  ///< >= 0
};

/// The first: it tells as much as one that is held for half the time after which it is another, for just confirmed it may yet be wrong.
/// The time of held is not used.
SpeedsSeen with_first_speed(const SpeedHeld& held, const TrackingConfig& config);

/// The same with one more speed; by the speeds at which people walk and run, and vehicles drive where there are people.
SpeedsSeen with_speed(const SpeedsSeen& before, const SpeedHeld& held, const TrackingConfig& config);

/// Bayes' rule over pedestrian, bicycle, car, truck or bus: how common they are where this was set up for, the sizes that were
/// seen with their uncertainty, and the speeds.
flow::ClassProbabilities class_probabilities(const Outline& outline, const SpeedsSeen& speeds, const TrackingConfig& config);

/// Unknown where no class is likelier than all others together.
flow::ObjectClass likeliest_class(const flow::ClassProbabilities& probability);

}  // namespace slammot::tracking
