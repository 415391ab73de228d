#pragma once

#include <cstddef>

#include "common/flow/tracked_objects.hpp"
#include "services/tracking/extent.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// Evidence of the class by the speeds of an object. Speeds of neighbouring scans are correlated:
/// they count by the time for which they were held, and older ones fade, since a vehicle in a queue
/// stays slow.
struct SpeedsSeen {
  flow::ClassProbabilities log_likelihood = {};
  double surely_mps = 0.0;  ///< Largest speed held for a while; does not fade.
};

/// The entry of a class in flow::ClassProbabilities; not of kUnknown.
constexpr std::size_t entry_of(flow::ObjectClass object_class) {
  return static_cast<std::size_t>(object_class) - 1;
}

/// Class of an object: pedestrian, bicycle, car, truck or bus.
/// Invariant: `likeliest` is that of likeliest_class(probability), as of the last update.
struct Classification {
  flow::ObjectClass likeliest = flow::ObjectClass::kUnknown;
  flow::ClassProbabilities probability = {};
  SpeedsSeen speeds;  ///< Since confirmation.

  double probability_of(flow::ObjectClass object_class) const {
    return probability[entry_of(object_class)];
  }
};

/// An estimate of the speed, held for some time.
struct SpeedHeld {
  double speed_mps = 0.0;
  double sigma_mps = 0.0;
  double time_s = 0.0;  ///< >= 0
};

/// The first speed, of a track just confirmed: it may be wrong, and counts as one held for half the
/// correlation time. The time of `held` is not used.
SpeedsSeen with_first_speed(const SpeedHeld& held, const TrackingConfig& config);

/// One speed later; likelihoods of the speeds at which people walk and run, and vehicles drive
/// among people.
SpeedsSeen with_speed(const SpeedsSeen& before, const SpeedHeld& held,
                      const TrackingConfig& config);

/// Posterior over pedestrian, bicycle, car, truck or bus by Bayes' rule: prior shares, the evidence
/// of the sizes, and of the speeds.
flow::ClassProbabilities class_probabilities(const Outline& outline, const SpeedsSeen& speeds,
                                             const TrackingConfig& config);

/// The class with a probability above one half; unknown if there is none.
flow::ObjectClass likeliest_class(const flow::ClassProbabilities& probability);

}  // namespace slammot::tracking
