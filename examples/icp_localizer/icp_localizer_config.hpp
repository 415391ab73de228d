#pragma once

namespace slammot::icp_localizer {

/// The settings of stage `localization` that this implementation reads, with the same names.
struct IcpLocalizerConfig {
  double match_range_m = 80.0;       ///< Greatest range of matched echoes.
  double map_range_m = 80.0;         ///< Greatest range of mapped echoes.
  double min_range_m = 0.3;          ///< Nearer echoes are of the vehicle itself.
  double range_noise_m = 0.03;       ///< One sigma.
  int min_echoes = 10;               ///< With fewer echoes the pose is the prediction.
  double least_matched_share = 0.3;  ///< Of the points; with fewer matched points the pose is the
                                     ///< prediction.
  int max_pending = 4;               ///< Scans with pending labels.
  bool use_odometry = true;          ///< Otherwise the prediction assumes constant velocity.
  double side_m = 240.0;             ///< Side of the square local map.
  double cell_size_m = 0.2;          ///< Of SO-map and MO-map.
  double surfel_size_m = 0.5;        ///< Cell size of the surfels for matching.
  double new_map_after_m = 60.0;     ///< Distance from its centre at which a new local map begins.
  double new_map_after_travel_m = 100.0;  ///< Distance travelled in a local map after which a new
                                          ///< one begins.
  double no_echo_free_m = 40.0;           ///< Length of free space along a beam without echo.
  double free_log_odds = 0.8;             ///< Least negative log-odds of a free cell.
  double end_cell_tolerance_m = 0.25;     ///< Distance to an occupied cell within which an echo is
                                          ///< explained.
  double drift_m_per_sqrt_m = 0.005;  ///< One sigma of the random walk of matched poses, for submap
                                      ///< constraints.
  double drift_rad_per_sqrt_m = 0.0002;
};

}  // namespace slammot::icp_localizer
