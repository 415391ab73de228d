#pragma once

#include "common/config/fields.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// The settings of tracking as message Tracking has them.
const config::FieldTable<TrackingConfig>& tracking_fields();

}  // namespace slammot::tracking
