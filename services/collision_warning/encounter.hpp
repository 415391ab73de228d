#pragma once

#include <optional>

#include "services/collision_warning/predicted_motion.hpp"

namespace slammot::collision_warning {

/// A predicted contact of both footprints.
struct Contact {
  double probability = 0.0;  ///< Of a first contact within the horizon.
  double after_s = 0.0;      ///< Its median.
};

/// The least distance of both footprints on their predicted paths.
struct ClosestApproach {
  double distance_m = 0.0;
  double after_s = 0.0;
};

/// Probability of a contact at any time within the predictions, which have the same steps. The
/// error of the relative position grows along the path by its covariance but does not change its
/// direction: it is sampled once, by 9 x 9 equally likely quantiles of a normal distribution, and
/// each sample is one relative trajectory. Steps of 0.1 s are exact where the boxes move by less
/// than their own extent in a step. None where no sample has a contact.
std::optional<Contact> contact(const PredictedBoxes& vehicle, const PredictedBoxes& object);

ClosestApproach closest_approach(const PredictedBoxes& vehicle, const PredictedBoxes& object);

}  // namespace slammot::collision_warning
