#pragma once

namespace slammot::icp_localizer {

/// The part of the settings of the stage `localization` that this implementation reads, under the
/// same names.
struct IcpLocalizerConfig {
  double match_range_m = 80.0;       ///< Echoes beyond it are not matched,
  double map_range_m = 80.0;         ///< and beyond this not mapped.
  double min_range_m = 0.3;          ///< Nearer echoes come from the vehicle itself.
  double range_noise_m = 0.03;       ///< One sigma.
  int min_echoes = 10;               ///< With fewer, the prediction is the pose.
  double least_matched_share = 0.3;  ///< Of the points; with fewer, the prediction is the pose.
  int max_pending = 4;               ///< Scans that wait for their labels.
  bool use_odometry = true;          ///< Off: constant velocity predicts.
  double side_m = 240.0;             ///< Of the local map, a square.
  double cell_size_m = 0.2;          ///< Of SO-map and MO-map.
  double surfel_size_m = 0.5;        ///< Of the cells whose echoes are averaged for matching.
  double new_map_after_m = 60.0;  ///< Distance from its centre at which the next local map begins,
                                  ///< or
  double new_map_after_travel_m = 100.0;  ///< distance travelled in it.
  double no_echo_free_m = 40.0;           ///< Free way of a beam without echo.
  double free_log_odds = 0.8;             ///< A cell with this much against it is free.
  double end_cell_tolerance_m = 0.25;     ///< An occupied cell this near explains an echo.
  double drift_m_per_sqrt_m = 0.005;  ///< Random walk of dead reckoning by matching, one sigma, for
                                      ///< submap constraints.
  double drift_rad_per_sqrt_m = 0.0002;
};

}  // namespace slammot::icp_localizer
