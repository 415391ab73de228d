#include "services/localization/localizer_presets.hpp"

#include <gtest/gtest.h>

namespace slammot::localization {
namespace {

TEST(LocalizerPresets, OfACarAndTheRoadAreTheDefaults) {
  const LocalizerConfig defaults;
  LocalizerConfig config;
  set_vehicle(config, Vehicle::robot);
  set_pose_error_model(config, PoseErrorModel::building);
  set_vehicle(config, Vehicle::car);
  set_pose_error_model(config, PoseErrorModel::road);
  EXPECT_EQ(config.vehicle, Vehicle::car);
  EXPECT_EQ(config.odometry.longest_step_s, defaults.odometry.longest_step_s);
  EXPECT_EQ(config.map.lasting.echo_log_odds, defaults.map.lasting.echo_log_odds);
  EXPECT_EQ(config.match.information_share, defaults.match.information_share);
  EXPECT_EQ(config.motion.position_noise_m, defaults.motion.position_noise_m);
  EXPECT_EQ(config.motion.position_noise_per_m, defaults.motion.position_noise_per_m);
  EXPECT_EQ(config.motion.sideways_noise_per_m, defaults.motion.sideways_noise_per_m);
  EXPECT_EQ(config.motion.heading_noise_per_m, defaults.motion.heading_noise_per_m);
  EXPECT_EQ(config.motion.heading_noise_per_rad, defaults.motion.heading_noise_per_rad);
  EXPECT_EQ(config.motion.heading_noise_rad, defaults.motion.heading_noise_rad);
  EXPECT_EQ(config.motion.askew_prior_rad, defaults.motion.askew_prior_rad);
  EXPECT_EQ(config.motion.pivot_prior_m, defaults.motion.pivot_prior_m);
  EXPECT_EQ(config.motion.pivot_walk_m, defaults.motion.pivot_walk_m);
  EXPECT_EQ(config.motion.speed_prior_mps, defaults.motion.speed_prior_mps);
  EXPECT_EQ(config.match.proven_after_m, defaults.match.proven_after_m);
  EXPECT_EQ(config.trust.mover_may_fill_view, defaults.trust.mover_may_fill_view);
  EXPECT_EQ(config.errors.variance_by_scans_alone, defaults.errors.variance_by_scans_alone);
  EXPECT_EQ(config.errors.pose_errors.forward.of_scan, defaults.errors.pose_errors.forward.of_scan);
}

TEST(LocalizerPresets, OfARobotTurnAboutItsMiddleAndHaveNoPitchingScanner) {
  LocalizerConfig config;
  set_vehicle(config, Vehicle::robot);
  EXPECT_EQ(config.vehicle, Vehicle::robot);
  EXPECT_LT(config.motion.pivot_walk_m, LocalizerConfig().motion.pivot_walk_m);
  EXPECT_LT(config.motion.speed_prior_mps, LocalizerConfig().motion.speed_prior_mps);
  EXPECT_EQ(config.match.proven_after_m, 0.0);
  EXPECT_FALSE(config.trust.mover_may_fill_view) << "a wall does, and tells how it moves";
}

TEST(LocalizerPresets, OfARobotBelieveASlippingStepLessAndAWallSeenOnce) {
  LocalizerConfig config;
  set_vehicle(config, Vehicle::robot);
  EXPECT_GT(config.motion.sideways_noise_per_m, LocalizerConfig().motion.sideways_noise_per_m);
  EXPECT_GT(config.motion.heading_noise_per_rad, LocalizerConfig().motion.heading_noise_per_rad);
  EXPECT_GT(config.odometry.longest_step_s, LocalizerConfig().odometry.longest_step_s);
  EXPECT_GT(config.match.information_share, LocalizerConfig().match.information_share);
  EXPECT_GT(config.map.lasting.echo_log_odds, 0.6) << "from which on one echo is a wall";
}

TEST(LocalizerPresets, OfABuildingReplacesAllPoseErrorsAndOfModelCarsThemAlone) {
  LocalizerConfig config;
  set_pose_error_model(config, PoseErrorModel::building);
  EXPECT_EQ(config.pose_error_model, PoseErrorModel::building);
  EXPECT_GT(config.errors.pose_errors.forward.of_map,
            LocalizerConfig().errors.pose_errors.forward.of_map);
  EXPECT_LT(config.errors.variance_by_scans_alone,
            LocalizerConfig().errors.variance_by_scans_alone);
  set_pose_error_model(config, PoseErrorModel::model_cars);
  EXPECT_GT(config.errors.pose_errors.forward.of_surprises,
            LocalizerConfig().errors.pose_errors.forward.of_surprises);
  EXPECT_EQ(config.errors.variance_by_scans_alone,
            LocalizerConfig().errors.variance_by_scans_alone);
}

}  // namespace
}  // namespace slammot::localization
