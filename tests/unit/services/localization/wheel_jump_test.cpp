#include "services/localization/wheel_jump.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace slammot::localization {
namespace {

using geometry::Pose2;

constexpr double kStep_s = 0.1;

bool is_jump(const Pose2& step) { return is_wheel_jump(step, 10.0, 0.3, kStep_s); }

TEST(WheelJump, IsNoneWhereTheVehicleGoesOnAsItDid) { EXPECT_FALSE(is_jump({1.0, 0.015, 0.03})); }

TEST(WheelJump, IsNoneWhereItBrakesAsHardAsVehiclesDo) {
  EXPECT_FALSE(is_jump({0.9, 0.015, 0.03}));
}

TEST(WheelJump, IsOneAheadBackOrAside) {
  EXPECT_TRUE(is_jump({1.5, 0.015, 0.03}));
  EXPECT_TRUE(is_jump({0.5, 0.015, 0.03}));
  EXPECT_TRUE(is_jump({1.0, 0.5, 0.03}));
}

TEST(WheelJump, IsOneWhereOnlyTheHeadingJumpsAlsoAcrossTheEndOfTheCircle) {
  EXPECT_TRUE(is_jump({1.0, 0.015, 0.5}));
  EXPECT_TRUE(is_wheel_jump({0.0, 0.0, -3.1}, 0.0, 0.0, kStep_s));
  EXPECT_FALSE(is_wheel_jump({0.0, 0.0, -3.1}, 0.0, 31.8, kStep_s));
}

TEST(WheelJump, IsNotToldFromDrivingOverALongStep) {
  EXPECT_FALSE(is_wheel_jump({5.0, 3.0, 2.0}, 0.0, 0.0, 2.0));
}

}  // namespace
}  // namespace slammot::localization
