#include "services/collision_warning/vehicle_motion.hpp"

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace slammot::collision_warning {
namespace {

using geometry::Pose2;

constexpr double kPeriodS = 0.027;

/// State after a drive with these speeds [m/s] at a constant yaw rate, with the noise of matched
/// poses.
VehicleState after_drive(double duration_s, const std::function<double(double)>& speed_mps,
                         double yaw_rate_radps) {
  std::mt19937 random(1);
  std::normal_distribution<double> position_m(0.0, 0.005);
  std::normal_distribution<double> heading_rad(0.0, 0.0005);
  VehicleMotion motion;
  VehicleState state;
  Pose2 odom_from_base{3.0, -2.0, 2.9};  // the heading passes pi
  const int scans = static_cast<int>(duration_s / kPeriodS);
  for (int i = 0; i <= scans; ++i) {
    const Pose2 noise{position_m(random), position_m(random), heading_rad(random)};
    state = motion.update(1'000'000'000 + std::int64_t{i} * 27'000'000, odom_from_base * noise);
    const double step_m = kPeriodS * speed_mps((i + 0.5) * kPeriodS);
    const double half_rad = 0.5 * kPeriodS * yaw_rate_radps;
    odom_from_base = odom_from_base * Pose2{step_m * std::cos(half_rad),
                                            step_m * std::sin(half_rad), 2.0 * half_rad};
  }
  return state;
}

TEST(VehicleMotion, KnowsSpeedAndTurnOfASteadyDrive) {
  const VehicleState state = after_drive(
      4.0, [](double) { return 10.0; }, 0.2);
  EXPECT_NEAR(state.speed_mps, 10.0, 0.1);
  EXPECT_NEAR(state.acceleration_mps2, 0.0, 0.5);
  EXPECT_NEAR(state.yaw_rate_radps, 0.2, 0.01);
}

TEST(VehicleMotion, SeesBrakingWithinHalfASecond) {
  const auto brakes_at_2_s = [](double t) { return 12.0 - 6.0 * std::max(0.0, t - 2.0); };
  const VehicleState state = after_drive(2.5, brakes_at_2_s, 0.0);
  EXPECT_NEAR(state.speed_mps, 9.0, 0.4);
  EXPECT_LT(state.acceleration_mps2, -3.5);
}

TEST(VehicleMotion, ReversesWithNegativeSpeed) {
  EXPECT_NEAR(after_drive(
                  3.0, [](double) { return -2.0; }, 0.0)
                  .speed_mps,
              -2.0, 0.1);
}

TEST(VehicleMotion, StartsAgainAfterAGap) {
  VehicleMotion motion;
  motion.update(0, {0.0, 0.0, 0.0});
  motion.update(100'000'000, {1.0, 0.0, 0.0});
  const VehicleState state = motion.update(5'000'000'000, {900.0, 0.0, 0.0});
  EXPECT_EQ(state.speed_mps, 0.0);
  EXPECT_EQ(state.odom_from_base.x_m, 900.0);
}

TEST(VehicleMotion, IgnoresScansOfOneStamp) {
  VehicleMotion motion;
  motion.update(0, {0.0, 0.0, 0.0});
  const double speed_mps = motion.update(100'000'000, {1.0, 0.0, 0.0}).speed_mps;
  EXPECT_GT(speed_mps, 5.0);
  EXPECT_EQ(motion.update(100'000'000, {1.1, 0.0, 0.0}).speed_mps, speed_mps);
}

}  // namespace
}  // namespace slammot::collision_warning
