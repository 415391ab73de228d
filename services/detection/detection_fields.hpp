#pragma once

#include "common/config/fields.hpp"
#include "services/detection/detector.hpp"

namespace slammot::detection {

/// The settings of detection as message Detection has them.
const config::FieldTable<DetectionConfig>& detection_fields();

}  // namespace slammot::detection
