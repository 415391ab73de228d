#pragma once

#include "services/localization/odometry_prediction.hpp"

namespace slammot::localization {

/// With the velocity of the step: another scanner's at the same time says nothing about it.
Step with_velocity(Step step, const OdometryPrediction::LastScan& last);

}  // namespace slammot::localization
