#pragma once

#include <vector>

#include "common/flow/segmented_scan.hpp"

namespace slammot::detection {

class BeamDirections;
struct DetectionConfig;

/// Marks in is_ground (one a beam) the echoes that a pitching scanner got from the ground; Wang
/// 2004, Section 6.6. The scan's plane meets flat ground in a line square to the vehicle's axis,
/// and what tells it from anything else of that shape is that no beam sees beyond it: whatever is
/// not in front of the line is on it. Needs the scan's points and point labels; looks only among
/// echoes labelled kMoving.
void find_ground(const flow::SegmentedScan& scan, const BeamDirections& directions,
                 const DetectionConfig& config, std::vector<char>& is_ground);

}  // namespace slammot::detection
