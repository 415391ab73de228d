#pragma once

#include "common/flow/localized_scan.hpp"
#include "common/flow/segmented_scan.hpp"
#include "common/sensing/segmentation.hpp"
#include "common/work/side_work.hpp"

namespace slammot::detection {

struct DetectionConfig {
  sensing::SegmentationConfig segmentation;
  double moving_share = 0.5;            ///< A segment moves when more than this of its decidable points do; Wang 2004, 6.2.
  double least_free_log_odds = 0.8;     ///< An end cell less surely free than this says nothing.
  double explained_within_m = 0.3;      ///< An echo this near to the outline that the map expects in its direction, and
  double explained_within_per_m = 0.006;///< so much more for each metre of range, contradicts nothing.
  double least_moving_evidence = 0.3;   ///< Where the MO-map remembers at least this much motion, what the map cannot
                                        ///< decide counts as moving: slow pedestrians; Wang 2004, 6.2.
  int largest_by_moving_evidence = 12;  ///< Points of a segment that may be held to be moving by the MO-map alone.
  int least_moving_run = 2;             ///< Moving beams side by side that make a segment of their own,
  int least_stationary_run = 3;         ///< and stationary ones.
  double longest_mover_m = 16.0;        ///< What is longer does not move as one thing.
  double range_noise_m = 0.03;          ///< One sigma at the scanner,
  double range_noise_per_m = 0.001;     ///< and what each metre of range adds.
  double ground_least_width_m = 3.0;    ///< Across the vehicle's axis; a pitching scanner's line on the ground is wide,
  double ground_thickness_m = 0.4;      ///< thin,
  double ground_heading_rad = 0.25;     ///< square to the vehicle's axis,
  double ground_nearest_m = 3.0;        ///< not right in front of the bumper,
  double ground_most_beyond = 0.2;      ///< and the end of sight: of the beams on it, so many at most see beyond.
  double occluder_margin_m = 0.5;       ///< A neighbouring echo nearer by this hides what lies behind it.
};

/// Cuts the scan into segments and tells which of them contradict the map, and so move. Stateless.
/// Consistency-based and MO-map-based detection of Wang 2004, Section 6.2. Every other echo is in exactly one segment.
/// Echoes from the ground (Section 6.6) are labelled kNoEcho and in no segment, because they tell of nothing that stands or moves.
/// done_with: a scan that nobody needs any more; its memory is used again, nothing else of it. With help (null: none) the result is the same.
flow::SegmentedScan detect(const flow::LocalizedScan& scan, const DetectionConfig& config, flow::SegmentedScan done_with = {}, work::SideWork* help = nullptr);

}  // namespace slammot::detection
