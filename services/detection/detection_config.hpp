#pragma once

#include "common/sensing/segmentation.hpp"

namespace slammot::detection {

struct DetectionConfig {
  sensing::SegmentationConfig segmentation;
  double moving_share = 0.5;  ///< A segment is moving if more than this share of its points with
                              ///< known label is; Wang 2004, section 6.2.
  double least_free_log_odds = 0.8;  ///< Least log-odds of free space that make an echo there
                                     ///< moving.
  double outline_tolerance_m = 0.3;  ///< Tolerance around the outline that the map predicts: echoes
                                     ///< within it are stationary.
  double outline_tolerance_per_m = 0.006;  ///< Increase of that tolerance per metre of range.
  /// A segment of unknown points is moving where the mean evidence of the MO-map is at least this:
  /// slow pedestrians; Wang 2004, section 6.2.
  double least_moving_evidence = 0.3;
  int largest_by_moving_evidence = 12;  ///< Most points of such a segment.
  int least_moving_run = 2;  ///< Fewest neighbouring moving beams that are a segment of their own.
  int least_stationary_run = 3;      ///< Fewest neighbouring stationary beams that are a segment of
                                     ///< their own.
  double longest_mover_m = 16.0;     ///< Longest segment that is labelled moving.
  double range_noise_m = 0.03;       ///< One sigma of a range at range zero.
  double range_noise_per_m = 0.001;  ///< Increase of that sigma per metre of range.
  double ground_least_width_m = 3.0;  ///< Least width of a ground line across the vehicle's axis.
  double ground_thickness_m = 0.4;    ///< Greatest distance of its echoes from the line, along the
                                      ///< axis.
  double ground_heading_rad = 0.25;   ///< Greatest deviation of a ground line from a right angle to
                                      ///< the axis.
  double ground_nearest_m = 3.0;      ///< Least distance of a ground line ahead of the scanner.
  double ground_max_beyond_share = 0.2;  ///< Greatest number of beams that see beyond a ground
                                         ///< line, as a share of those on it.
  double occluder_margin_m = 0.5;  ///< A neighbouring echo nearer by more than this occludes the
                                   ///< end of a segment.
};

}  // namespace slammot::detection
