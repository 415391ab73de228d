#include "services/tracking/measurement_update.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/example_tracks.hpp"

namespace slammot::tracking {
namespace {

using testing::known_car;
using testing::known_walker;
using testing::kPeriodS;
using testing::see;

TEST(MeasurementUpdate, CountsHowFarEchoesLieOffItsSidesWhileItIsAVehicleThatIsConfirmed) {
  const TrackingConfig config;
  std::vector<Eigen::Vector2d> points_m;
  for (int i = 0; i < 12; ++i)
    points_m.emplace_back(10.0, -0.9 + 1.8 / 11.0 * i);  // the back of a car
  Observation observation;
  observation.points_m = points_m;
  observation.beam_step_rad = 0.015;
  Track track = known_car();
  track.kinematics.estimate.mean.head<2>() = Eigen::Vector2d(12.3, 0.0);
  track.kinematics.estimate.covariance = 0.01 * track.kinematics.estimate.covariance.Identity();
  track.kinematics.mixture = filters::imm_start(motion_models(config), track.kinematics.estimate);
  Track tentative = track;
  tentative.existence.confirmed = false;
  ASSERT_TRUE(update(track, 27'000'000, observation, Eigen::Matrix2d::Zero(), config));
  EXPECT_EQ(track.extent.outline_error.scans, 1);
  EXPECT_EQ(track.extent.outline_error.echoes, 12.0);
  EXPECT_LT(track.extent.outline_error.shares, 12.0);
  EXPECT_NEAR(track.extent.range_m, 12.3, 0.3);
  ASSERT_TRUE(update(tentative, 27'000'000, observation, Eigen::Matrix2d::Zero(), config));
  EXPECT_EQ(tentative.extent.outline_error.scans, 0);
}

TEST(MeasurementUpdate, OfOneKnownToWalkGoesOnThoughItIsGivenTheEchoesOfOneWhoComesTowardsThem) {
  const TrackingConfig config;
  Track track = known_walker(0.0, config);
  for (int i = 0; i < 40; ++i) see(track, {1.3 * kPeriodS * (i + 1), 8.0}, 0.4, config);
  ASSERT_TRUE(is_known_pedestrian(track));
  const double met_m = track.position_m().x();
  for (int i = 0; i < 10; ++i)
    see(track, {met_m + 0.3 - 1.3 * kPeriodS * (i + 1), 7.6}, 0.4, config);
  EXPECT_GT(track.velocity_mps().x(), 0.9);
  EXPECT_LT(std::abs(track.velocity_mps().y()), 0.5);
}

TEST(MeasurementUpdate, OfOneKnownToWalkFollowsThemWhenTheyStop) {
  const TrackingConfig config;
  Track track = known_walker(0.0, config);
  for (int i = 0; i < 40; ++i) see(track, {1.3 * kPeriodS * (i + 1), 8.0}, 0.4, config);
  const double stopped_m = 1.3 * kPeriodS * 40;
  for (int i = 0; i < 40; ++i) see(track, {stopped_m, 8.0}, 0.4, config);
  EXPECT_LT(track.velocity_mps().norm(), 0.3);
  EXPECT_NEAR(track.position_m().x(), stopped_m, 0.2);
}

TEST(MeasurementUpdate, OfOneKnownToWalkIsSomebodyWhoWalksThoughTheFilterSaysThatTheyFly) {
  const TrackingConfig config;
  const auto noise_m2 = [&](double speed_mps, bool is_known) {
    Track track = known_walker(0.0, config);
    track.existence.hits = is_known ? 100 : 10;
    track.kinematics.mixture.modes[0].mean[2] = track.kinematics.mixture.modes[1].mean[2] =
        speed_mps;
    see(track, {speed_mps * kPeriodS, 8.0}, 0.4, config);
    return track.kinematics.measured->R(0, 0);
  };
  EXPECT_LT(noise_m2(3.5, false), 0.3 * noise_m2(1.3, false)) << "no legs swing at that speed";
  EXPECT_NEAR(noise_m2(3.5, true), noise_m2(1.3, true), 0.01);
}

TEST(MeasurementUpdate, OfOneKnownToWalkGoesOnAtTheirVelocityWhileHidden) {
  const TrackingConfig config;
  Track track = known_walker(0.0, config);
  for (filters::MotionState& mode : track.kinematics.mixture.modes)
    mode.mean[4] = -1.5;  // as if they were about to turn round
  for (int i = 0; i < 37; ++i) predict(track, kPeriodS, config);
  EXPECT_NEAR(track.velocity_mps().x(), 1.3, 0.05);
}

}  // namespace
}  // namespace slammot::tracking
