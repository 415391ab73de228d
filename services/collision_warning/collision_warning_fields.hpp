#pragma once

#include "common/config/fields.hpp"
#include "services/collision_warning/collision_warning_config.hpp"

namespace slammot::collision_warning {

/// Settings of collision warning, as in message CollisionWarning.
const config::FieldTable<CollisionWarningConfig>& collision_warning_fields();

}  // namespace slammot::collision_warning
