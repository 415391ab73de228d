#pragma once

#include "common/flow/localized_scan.hpp"
#include "common/flow/segmented_scan.hpp"
#include "services/detection/beam_directions.hpp"
#include "services/detection/detection_config.hpp"

namespace slammot::detection {

/// Sets points, ranges and labels of `segmented`: consistency of each echo with the map; Wang 2004,
/// section 6.2.
void label_points(const flow::LocalizedScan& scan, const BeamDirections& directions,
                  const DetectionConfig& config, flow::SegmentedScan& segmented);

}  // namespace slammot::detection
