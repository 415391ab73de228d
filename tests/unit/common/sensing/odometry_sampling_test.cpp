#include "common/sensing/odometry_sampling.hpp"

#include <gtest/gtest.h>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace slammot::sensing {
namespace {

using geometry::Pose2;

TEST(HeldPoses, TellHowLongTheyAreHeld) {
  HeldPoses held;
  for (int i = 0; i < 100; ++i) held.add({0.1 * (i / 4), 0.0, 0.0});
  EXPECT_EQ(held.most_scans(), 7U) << "three repeat one";
}

TEST(HeldPoses, AreNoneOfAVehicleThatStandsAtTimes) {
  HeldPoses held;
  for (int i = 0; i < 300; ++i) held.add({0.1 * (i % 100 < 50 ? i % 100 : 50), 0.0, 0.0});
  EXPECT_EQ(held.most_scans(), 0U);
  EXPECT_EQ(HeldPoses().most_scans(), 0U);
}

TEST(PoseNoise, IsTheChangeOfTheSidewaysStep) {
  PoseNoise noise;
  PoseNoise of_a_turn;
  PoseNoise of_a_jump;
  Pose2 turning;
  for (int i = 0; i < 1000; ++i) {
    noise.add({0.1 * i, i % 2 == 0 ? 0.01 : -0.01, 0.0});
    of_a_turn.add(turning);
    turning = turning * Pose2{0.1, 0.0002, 0.004};
    of_a_jump.add({0.1 * i, i < 500 ? 0.0 : 100.0, 0.0});
  }
  EXPECT_NEAR(noise.mean_m(), 0.04, 1e-3);
  EXPECT_LT(of_a_turn.mean_m(), 1e-6);
  EXPECT_LT(of_a_jump.mean_m(), 1.1e-3);
}

TEST(PoseNoise, IsNotToldByFewStepsOrAVehicleThatStands) {
  PoseNoise few;
  PoseNoise standing;
  for (int i = 0; i < 20; ++i) few.add({0.1 * i, i % 2 * 0.01, 0.0});
  for (int i = 0; i < 1000; ++i) standing.add({0.0, i % 2 * 0.001, 0.0});
  EXPECT_EQ(few.mean_m(), 0.0);
  EXPECT_EQ(standing.mean_m(), 0.0);
}

/// A car that speeds up, brakes and turns, 37 samples a second, each read so much earlier than it
/// is stamped, at random.
std::vector<Odometry> car_with_jitter(double most_s) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> early_s(0.0, most_s);
  std::vector<Odometry> samples;
  for (int i = 0; i < 2000; ++i) {
    const double time_s = 0.027 * i - early_s(random);
    samples.push_back(
        {std::int64_t{27'000'000} * i, {8.0 * time_s + 6.0 * std::sin(0.5 * time_s), 0.0, 0.0}});
  }
  return samples;
}

TEST(ForwardNoise, IsThatOfPosesReadAtOtherTimesThanTheyAreStamped) {
  EXPECT_EQ(forward_noise_m(car_with_jitter(0.0)), 0.0);
  EXPECT_NEAR(forward_noise_m(car_with_jitter(0.02)), 0.06, 0.02);
}

TEST(TurnNoise, IsThatOfACompassAndNoneOfWheels) {
  std::vector<Odometry> samples = car_with_jitter(0.0);
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i].wheel_from_base.heading_rad = 0.8 * std::sin(0.027 * static_cast<double>(i));
  EXPECT_EQ(turn_noise_rad(samples), 0.0);
  std::mt19937 random(7);
  std::normal_distribution<double> noise_rad(0.0, 0.03);
  for (Odometry& sample : samples) sample.wheel_from_base.heading_rad += noise_rad(random);
  EXPECT_NEAR(turn_noise_rad(samples), 0.045, 0.01);
}

TEST(ForwardNoise, IsNoneOfMissingSamples) {
  std::vector<Odometry> samples = car_with_jitter(0.0);
  for (std::size_t i = 10; i < 1500; i += 7)
    samples.erase(samples.begin() + static_cast<std::ptrdiff_t>(i));
  EXPECT_EQ(forward_noise_m(samples), 0.0);
}

}  // namespace
}  // namespace slammot::sensing
