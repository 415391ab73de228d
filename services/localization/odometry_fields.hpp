#pragma once

#include "common/config/fields.hpp"
#include "services/localization/localizer_config.hpp"

namespace slammot::localization {

/// Kind of the vehicle; sets what depends on it.
config::Field<LocalizerConfig> vehicle_field();

config::FieldTable<OdometryConfig> odometry_fields();

config::FieldTable<sensing::MotionModelConfig> motion_fields();

config::FieldTable<sensing::OdometryBeliefConfig> belief_fields();

}  // namespace slammot::localization
