#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/flow/localized_scan.hpp"
#include "common/flow/segmented_scan.hpp"
#include "common/memory/spares.hpp"
#include "common/sensing/segmentation.hpp"
#include "common/work/side_work.hpp"
#include "services/detection/beam_directions.hpp"

namespace slammot::detection {

struct DetectionConfig {
  sensing::SegmentationConfig segmentation;
  double moving_share = 0.5;  ///< A segment moves when more than this of its decidable points do;
                              ///< Wang 2004, 6.2.
  double least_free_log_odds = 0.8;  ///< An end cell less surely free than this says nothing.
  double explained_within_m = 0.3;   ///< An echo this near to the outline that the map expects in
                                     ///< its direction, and
  double explained_within_per_m = 0.006;  ///< so much more for each metre of range, contradicts
                                          ///< nothing.
  double least_moving_evidence = 0.3;     ///< Where the MO-map remembers at least this much motion,
                                          ///< what the map cannot decide counts as moving: slow
                                          ///< pedestrians; Wang 2004, 6.2.
  int largest_by_moving_evidence = 12;    ///< Points of a segment that may be held to be moving by
                                          ///< the MO-map alone.
  int least_moving_run = 2;       ///< Moving beams side by side that make a segment of their own,
  int least_stationary_run = 3;   ///< and stationary ones.
  double longest_mover_m = 16.0;  ///< What is longer does not move as one thing.
  double range_noise_m = 0.03;    ///< One sigma at the scanner,
  double range_noise_per_m = 0.001;   ///< and what each metre of range adds.
  double ground_least_width_m = 3.0;  ///< Across the vehicle's axis; a pitching scanner's line on
                                      ///< the ground is wide,
  double ground_thickness_m = 0.4;    ///< thin,
  double ground_heading_rad = 0.25;   ///< square to the vehicle's axis,
  double ground_nearest_m = 3.0;      ///< not right in front of the bumper,
  double ground_most_beyond = 0.2;    ///< and the end of sight: of the beams on it, so many at most
                                      ///< see beyond.
  double occluder_margin_m = 0.5;     ///< A neighbouring echo nearer by this hides what lies behind
                                      ///< it.
};

/// Neighbouring echoes of one label, as indices into the beams of what is cut.
struct Run {
  std::size_t first = 0;
  std::size_t count = 0;
  bool is_moving = false;
};

/// Cuts scans into segments and tells which of them contradict the map, and so move.
/// Consistency-based and MO-map-based detection of Wang 2004, Section 6.2. Every other echo is in
/// exactly one segment. Echoes from the ground (Section 6.6) are labelled kNoEcho and in no
/// segment, because they tell of nothing that stands or moves. Keeps nothing from scan to scan but
/// memory: given back what it made of the last one, it allocates nothing in the long run.
class Detector {
 public:
  /// With help (null: none), which must outlive this, the results are the same.
  explicit Detector(const DetectionConfig& config, work::SideWork* help = nullptr)
      : config_(config), help_(help) {}

  /// done_with: a scan that nobody needs any more; its memory is used again, nothing else of it.
  flow::SegmentedScan detect(const flow::LocalizedScan& scan, flow::SegmentedScan done_with = {});

 private:
  void leave_out_ground(flow::SegmentedScan& scan);
  void cut(const flow::LocalizedScan& localized, flow::SegmentedScan& scan);
  void finish_segments(const flow::LocalizedScan& localized, flow::SegmentedScan& scan);

  static constexpr std::size_t kRanges = 4;  ///< In which segments are finished: they are of very
                                             ///< different sizes.
  DetectionConfig config_;
  work::SideWork* help_;
  memory::Spares<flow::Segment> spare_segments_;
  /// Of the scan at hand; kept to reuse the memory.
  BeamDirections directions_;
  std::vector<char> is_ground_;
  std::vector<float> range_without_ground_m_;
  std::vector<sensing::BeamSpan> spans_;
  std::vector<std::uint16_t> beams_;
  std::vector<Run> runs_;
  std::array<std::vector<geometry::Vector2>, kRanges> points_in_odom_m_;
};

/// The same of a single scan.
flow::SegmentedScan detect(const flow::LocalizedScan& scan, const DetectionConfig& config);

}  // namespace slammot::detection
