#include "common/sensing/odometry_sampling.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace slammot::sensing
