#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace slammot::sensing {

/// Thresholds on the distance between neighbouring echoes of one segment.
struct SegmentationConfig {
  double gap_m = 0.3;  ///< Allowed gap at range zero; other distances are multiples of it.
};

/// Beams [first, last] of one segment; beams without echo may lie between.
struct BeamSpan {
  std::uint16_t first = 0;
  std::uint16_t last = 0;
};

/// Segments a scan at gaps larger than the range explains (Wang 2004, Section 3.2, "Scan
/// Segmentation"). Points in any common frame [m]; range_m is 0 for no echo; one of each a beam.
/// beam_step_rad may have either sign. Gaps of a wall at grazing incidence grow; its echoes form
/// one segment while they lie on its line. So do three or more single echoes of a dark object that
/// returns less than half of the beams. Fills `spans` in ascending order and reuses its memory.
void segment_by_distance(std::span<const Eigen::Vector2f> points_m, std::span<const float> range_m,
                         double beam_step_rad, const SegmentationConfig& config,
                         std::vector<BeamSpan>& spans);

/// True if the last span of a full-circle scan continues in its first span, without an object's
/// edge in between.
bool continues_across_seam(std::span<const Eigen::Vector2f> points_m,
                           std::span<const float> range_m, double beam_step_rad,
                           const SegmentationConfig& config, std::span<const BeamSpan> spans);

}  // namespace slammot::sensing
