#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace slammot::sensing {

/// How far apart neighbouring echoes of one thing may lie.
struct SegmentationConfig {
  double gap_m = 0.3;              ///< At no distance,
  double gap_beam_spacings = 3.0;  ///< and this many times the distance between neighbouring beams there.
  double widest_gap_m = 1.5;
  int bridged_beams = 2;           ///< Beams without echo that may lie between two echoes of one thing.
  double line_gap_m = 6.0;         ///< A straight wall seen at a grazing angle goes on across so wide a gap,
  double line_gap_growth = 2.5;    ///< at most so many times the one before,
  double line_tolerance_m = 0.25;  ///< when the next echo lies this near to its line.
  double dark_gap_m = 1.5;         ///< Echoes of something dark, one here and one there on a line, lie no farther apart,
  int dark_gap_beams = 12;         ///< with no more beams between them that are not answered; 0: they are not joined.
};

/// Beams [first, last] of one segment; beams without echo may lie between.
struct BeamSpan {
  std::uint16_t first = 0;
  std::uint16_t last = 0;
};

/// Cuts a scan where neighbouring echoes lie farther apart than the range explains (Wang 2004, Section 3.2, "Scan
/// Segmentation"). Points in any one frame, m; range_m 0 for no echo, one each a beam. beam_step_rad may have any sign.
/// Echoes of a wall at a grazing angle lie ever farther apart; they stay together as long as they lie on its line. So do
/// three or more single echoes of something dark that answers to less than half of the beams.
/// Fills `spans`, ascending, which keeps its memory from scan to scan.
void segment_by_distance(std::span<const Eigen::Vector2f> points_m, std::span<const float> range_m, double beam_step_rad,
                         const SegmentationConfig& config, std::vector<BeamSpan>& spans);

/// Whether the last span of a scan that goes all round goes on in its first one, with no end of a thing in between.
bool goes_on_across_seam(std::span<const Eigen::Vector2f> points_m, std::span<const float> range_m, double beam_step_rad,
                         const SegmentationConfig& config, std::span<const BeamSpan> spans);

}  // namespace slammot::sensing
