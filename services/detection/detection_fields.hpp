#pragma once

#include "common/config/fields.hpp"
#include "services/detection/detection_config.hpp"

namespace slammot::detection {

/// Settings of detection, as in message Detection.
const config::FieldTable<DetectionConfig>& detection_fields();

}  // namespace slammot::detection
