#pragma once

#include <vector>

#include "common/flow/segmented_scan.hpp"

namespace slammot::detection {

class BeamDirections;

/// Marks in `is_ground` (one value a beam) the echoes of a pitching scanner from the ground; Wang
/// 2004, section 6.6. The scan plane intersects flat ground in a line square to the vehicle's axis.
/// Unlike an object of this shape, no beam sees beyond it: every echo is in front of the line or on
/// it. Requires points and point labels of the scan; only echoes labelled kMoving are candidates.
void find_ground(const flow::SegmentedScan& scan, const BeamDirections& directions,
                 std::vector<char>& is_ground);

}  // namespace slammot::detection
