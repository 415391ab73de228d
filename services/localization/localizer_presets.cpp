#include "services/localization/localizer_presets.hpp"

namespace slammot::localization {
namespace {

/// Fitted by NEES to the scenarios `office` and `corridor`: ranges are a few metres, so a small
/// part of the map is in view.
constexpr sensing::PoseErrors kInBuildings{
    .forward = {.of_scan = 0.3, .of_surprises = 1.7, .of_map = 1.0, .view_m = 1.0},
    .sideways = {.of_scan = 0.25, .of_surprises = 1.4, .of_map = 1.0, .view_m = 0.5},
    .heading = {.of_scan = 0.07, .of_surprises = 1.6, .of_map = 0.6, .view_m = 0.1}};
constexpr double kVarianceByScansAloneInBuildings = 2.0;

/// From innovations alone: the ground truth of these recordings is too far off in time to fit more.
constexpr sensing::PoseErrors kOfModelCars{
    .forward = {.of_scan = 0.0002, .of_surprises = 14.0, .of_map = 0.0, .view_m = 0.001},
    .sideways = {.of_scan = 0.0005, .of_surprises = 2.8, .of_map = 0.0, .view_m = 0.001},
    .heading = {.of_scan = 0.019, .of_surprises = 3.0, .of_map = 0.0, .view_m = 0.001}};

void set_robot(LocalizerConfig& config) {
  config.odometry.longest_step_s = 30.0;    // subsampled logs have a scan only every metre
  config.map.lasting.echo_log_odds = 0.65;  // and see a wall once: one echo suffices
  config.motion.position_noise_m = 0.004;
  config.motion.position_noise_per_m = 0.08;
  config.motion.sideways_noise_per_m = 0.08;  // skid steering
  config.motion.heading_noise_rad = 0.004;
  config.motion.heading_noise_per_m = 0.05;
  config.motion.heading_noise_per_rad = 0.1;
  config.motion.turn_factor_prior = 0.0;  // turns slip, each differently
  config.motion.askew_prior_rad = 0.0;    // a sweep changes a scan much as a scanner mounted askew
  config.motion.pivot_prior_m = 0.2;  // logs take the scanner for the middle, and it swings round
                                      // it
  config.motion.pivot_walk_m = 0.03;  // the wheels are not metres behind the middle
  config.motion.speed_prior_mps = 1.5;
  config.match.proven_after_m = 0.0;         // a slow robot does not pitch
  config.trust.mover_may_fill_view = false;  // what fills it is a wall
  config.match.information_share = 0.8;      // errors of scans half a metre apart are nearly
                                             // independent
}

void set_car(LocalizerConfig& config) {
  const LocalizerConfig defaults;
  config.odometry.longest_step_s = defaults.odometry.longest_step_s;
  config.map.lasting.echo_log_odds = defaults.map.lasting.echo_log_odds;
  config.motion.position_noise_m = defaults.motion.position_noise_m;
  config.motion.position_noise_per_m = defaults.motion.position_noise_per_m;
  config.motion.sideways_noise_per_m = defaults.motion.sideways_noise_per_m;
  config.motion.heading_noise_rad = defaults.motion.heading_noise_rad;
  config.motion.heading_noise_per_m = defaults.motion.heading_noise_per_m;
  config.motion.heading_noise_per_rad = defaults.motion.heading_noise_per_rad;
  config.motion.turn_factor_prior = defaults.motion.turn_factor_prior;
  config.motion.askew_prior_rad = defaults.motion.askew_prior_rad;
  config.motion.pivot_prior_m = defaults.motion.pivot_prior_m;
  config.motion.pivot_walk_m = defaults.motion.pivot_walk_m;
  config.motion.speed_prior_mps = defaults.motion.speed_prior_mps;
  config.match.proven_after_m = defaults.match.proven_after_m;
  config.trust.mover_may_fill_view = defaults.trust.mover_may_fill_view;
  config.match.information_share = defaults.match.information_share;
}

}  // namespace

void set_vehicle(LocalizerConfig& config, Vehicle vehicle) {
  config.vehicle = vehicle;
  switch (vehicle) {
    case Vehicle::car: set_car(config); break;
    case Vehicle::robot: set_robot(config); break;
  }
}

void set_pose_error_model(LocalizerConfig& config, PoseErrorModel model) {
  const LocalizerConfig defaults;
  config.pose_error_model = model;
  config.errors.pose_errors = defaults.errors.pose_errors;
  config.errors.variance_by_scans_alone = defaults.errors.variance_by_scans_alone;
  switch (model) {
    case PoseErrorModel::road: break;
    case PoseErrorModel::building:
      config.errors.pose_errors = kInBuildings;
      config.errors.variance_by_scans_alone = kVarianceByScansAloneInBuildings;
      break;
    case PoseErrorModel::model_cars: config.errors.pose_errors = kOfModelCars; break;
  }
}

}  // namespace slammot::localization
