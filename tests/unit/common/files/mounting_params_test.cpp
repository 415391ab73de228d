#include "common/files/mounting_params.hpp"

#include <numbers>

#include <gtest/gtest.h>

namespace slammot::files {
namespace {

using geometry::Pose2;

constexpr LaserRecordKind kKind = LaserRecordKind::kRobotLaser1;

TEST(MountingParams, PlacesTheFrontScanner) {
  MountingParams params;
  EXPECT_FALSE(params.base_from_laser(kKind, 1));
  params.add({"robot_frontlaser_offset", "0.3"});
  params.add({"robot_frontlaser_side_offset", "-0.1"});
  params.add({"robot_frontlaser_angular_offset", "0.2"});
  EXPECT_EQ(params.base_from_laser(kKind, 1), (Pose2{0.3, -0.1, 0.2}));
  EXPECT_FALSE(params.base_from_laser(kKind, 2));
}

TEST(MountingParams, PlacesTheRearScannerBehindTheCentreLookingBackwards) {
  MountingParams params;
  params.add({"robot_rearlaser_offset", "0.3"});
  EXPECT_EQ(params.base_from_laser(kKind, 2), (Pose2{-0.3, 0.0, std::numbers::pi}));
}

TEST(MountingParams, PrefersTheNumberOfAScannerAndTakesItAsItIs) {
  MountingParams params;
  params.add({"robot_rearlaser_offset", "0.3"});
  params.add({"robot_laser2_offset", "0.5"});
  params.add({"robot_laser7_side_offset", "1.5"});
  EXPECT_EQ(params.base_from_laser(kKind, 2), (Pose2{0.5, 0.0, 0.0}));
  EXPECT_EQ(params.base_from_laser(kKind, 7), (Pose2{0.0, 1.5, 0.0}));
}

TEST(MountingParams, SaysNothingOfScannersOfBags) {
  MountingParams params;
  params.add({"robot_frontlaser_offset", "0.3"});
  EXPECT_FALSE(params.base_from_laser(LaserRecordKind::kBag, 1));
}

TEST(MountingParams, KnowsTiltAndRange) {
  MountingParams params;
  params.add({"robot_frontlaser_roll_offset", "1.5"});
  params.add({"robot_rear_laser_max", "30"});
  EXPECT_EQ(params.tilt(kKind, 1).roll_rad, 1.5);
  EXPECT_EQ(params.tilt(kKind, 2).roll_rad, 0.0);
  EXPECT_EQ(params.max_range_m(1), 0.0);
  EXPECT_EQ(params.max_range_m(2), 30.0);
  EXPECT_EQ(params.max_range_m(3), 0.0);
}

TEST(MountingParams, LeavesOutWhatIsNoOffset) {
  MountingParams params;
  params.add({"robot_frontlaser_offset", "far"});
  params.add({"robot_frontlaser_offset", "150"});
  params.add({"robot_laser_offset", "0.3"});
  params.add({"robot_laser0_offset", "0.3"});
  EXPECT_FALSE(params.base_from_laser(kKind, 1));
}

}  // namespace
}  // namespace slammot::files
