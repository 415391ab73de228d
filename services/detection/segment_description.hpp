#pragma once

#include <vector>

#include "common/flow/localized_scan.hpp"
#include "common/flow/segmented_scan.hpp"
#include "common/geometry/pose2.hpp"
#include "services/detection/detection_config.hpp"

namespace slammot::detection {

/// A segment of unknown points is moving where the mean evidence of the MO-map is at least this:
/// slow pedestrians; Wang 2004, section 6.2.
inline constexpr double kLeastMovingEvidence = 0.3;
/// Most points of such a segment.
inline constexpr int kLargestByMovingEvidence = 12;

/// Sets label, occlusion, centroid and box of a segment from its beams. `points_in_odom_m`: buffer.
void describe_segment(flow::Segment& segment, const flow::LocalizedScan& localized,
                      const DetectionConfig& config, const flow::SegmentedScan& scan,
                      const geometry::Matrix2& odom_from_base_turn,
                      std::vector<geometry::Vector2>& points_in_odom_m);

}  // namespace slammot::detection
