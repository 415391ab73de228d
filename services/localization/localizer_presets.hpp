#pragma once

#include "services/localization/localizer_config.hpp"

namespace slammot::localization {

/// Sets what depends on the kind of the vehicle: the noise of its odometry, where it turns, its
/// speed at the start of a log, whether its scanner pitches, and how many scans of it show a wall.
/// Vehicle::car: the defaults.
void set_vehicle(LocalizerConfig& config, Vehicle vehicle);

/// Sets the model of the errors of published poses: docs/decisions/pose-covariance.md.
void set_pose_error_model(LocalizerConfig& config, PoseErrorModel model);

}  // namespace slammot::localization
