#include "common/simulation/vehicle_model.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"

namespace slammot::simulation {
namespace {

using geometry::Pose2;
using slammot::testing::PoseNear;

constexpr double kStep_s = 1.0 / 37.5;

OdometryConfig exact_odometry() {
  OdometryConfig config;
  config.scale_error_low = config.scale_error_high = 0.0;
  config.distance_noise = config.heading_noise_rad = 0.0;
  config.rate_bias_sigma_radps = config.rate_bias_walk_radps = 0.0;
  return config;
}

TEST(Suspension, SettlesAtThePitchOfAConstantBraking) {
  const SuspensionConfig config;
  Suspension suspension(config);
  double nose_down_rad = 0.0;
  for (int i = 0; i < 300; ++i) nose_down_rad = suspension.advance(-4.0, kStep_s);
  EXPECT_NEAR(nose_down_rad, 4.0 * config.pitch_per_mps2_rad, 1e-4);
}

TEST(Suspension, ComesBackAfterBraking) {
  Suspension suspension{SuspensionConfig{}};
  for (int i = 0; i < 60; ++i) suspension.advance(-5.0, kStep_s);
  double nose_down_rad = 1.0;
  for (int i = 0; i < 300; ++i) nose_down_rad = suspension.advance(0.0, kStep_s);
  EXPECT_NEAR(nose_down_rad, 0.0, 1e-4);
}

TEST(WheelOdometer, FollowsTheTruthWhenNothingIsWrongWithIt) {
  WheelOdometer odometer(exact_odometry(), 1);
  // Chords of a circle leave at half their turn.
  const double turn_rad = 0.01;
  const Pose2 before_from_after{0.2 * std::cos(0.5 * turn_rad), 0.2 * std::sin(0.5 * turn_rad),
                                turn_rad};
  Pose2 start_from_base;
  for (int i = 0; i < 500; ++i) {
    odometer.advance(before_from_after, kStep_s);
    start_from_base = start_from_base * before_from_after;
  }
  EXPECT_THAT(odometer.wheel_from_base(), PoseNear(start_from_base, 1e-9));
}

TEST(WheelOdometer, MisjudgesDistanceByItsScale) {
  OdometryConfig config = exact_odometry();
  config.scale_error_low = config.scale_error_high = 0.01;
  WheelOdometer odometer(config, 1);
  for (int i = 0; i < 1000; ++i) odometer.advance({0.1, 0.0, 0.0}, kStep_s);
  EXPECT_NEAR(std::abs(odometer.wheel_from_base().x_m - 100.0), 1.0, 1e-9);
}

TEST(WheelOdometer, TurnsSlowlyAtRestByItsRateBias) {
  OdometryConfig config = exact_odometry();
  config.rate_bias_sigma_radps = 0.001;
  WheelOdometer odometer(config, 1);
  for (int i = 0; i < 1000; ++i) odometer.advance(Pose2::identity(), kStep_s);
  EXPECT_EQ(odometer.wheel_from_base().x_m, 0.0);
  EXPECT_NE(odometer.wheel_from_base().heading_rad, 0.0);
}

}  // namespace
}  // namespace slammot::simulation
