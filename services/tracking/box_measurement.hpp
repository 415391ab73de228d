#pragma once

#include <Eigen/Core>

#include "services/tracking/box.hpp"
#include "services/tracking/centre_measurement.hpp"
#include "services/tracking/observation.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

struct BoxMeasurement : CentreMeasurement {
  Box box;  ///< With the sizes after the measurement.
};

/// Centre and sizes of a box from one observation. Visible sides fix the box; hidden ones follow
/// from its size. An end behind an occluder fixes nothing, but bounds the size from below.
BoxMeasurement measure_box(const Box& box, const Eigen::Vector2d& predicted_centre_m,
                           const Observation& observation, const TrackingConfig& config);

/// Centre alone, of a box of exactly this size.
Eigen::Vector2d box_centre_m(const Box& box, const Eigen::Vector2d& predicted_centre_m,
                             const Observation& observation, const TrackingConfig& config);

}  // namespace slammot::tracking
