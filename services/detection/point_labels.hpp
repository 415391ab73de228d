#pragma once

#include "common/flow/localized_scan.hpp"
#include "common/flow/segmented_scan.hpp"
#include "services/detection/beam_directions.hpp"

namespace slammot::detection {

/// Tolerance around the outline that the map predicts: echoes within it are stationary.
inline constexpr double kOutlineToleranceM = 0.3;

/// Sets points, ranges and labels of `segmented`: consistency of each echo with the map; Wang 2004,
/// section 6.2.
void label_points(const flow::LocalizedScan& scan, const BeamDirections& directions,
                  flow::SegmentedScan& segmented);

}  // namespace slammot::detection
