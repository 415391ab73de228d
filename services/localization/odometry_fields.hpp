#pragma once

#include "common/config/fields.hpp"
#include "services/localization/localizer_config.hpp"

namespace slammot::localization {

/// Settings of odometry that are members of LocalizerConfig itself.
config::FieldTable<LocalizerConfig> odometry_fields();

config::FieldTable<sensing::MotionModelConfig> motion_fields();

config::FieldTable<sensing::OdometryBeliefConfig> belief_fields();

}  // namespace slammot::localization
