#include "common/sensing/stray_poses.hpp"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slammot::sensing {
namespace {

using geometry::Pose2;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// A robot that weaves along x, away from the origin.
std::vector<Pose2> drive() {
  std::vector<Pose2> poses;
  for (int i = 0; i < 200; ++i) poses.push_back({5.0 + 0.1 * i, 2.0, 0.4 * std::sin(0.1 * i)});
  return poses;
}

std::vector<std::size_t> stray_in(const std::vector<Pose2>& poses) {
  std::vector<std::size_t> places;
  for (const StrayPose& stray : stray_poses(poses)) places.push_back(stray.place);
  return places;
}

TEST(StrayPoses, AreNoneOfADrive) { EXPECT_THAT(stray_in(drive()), IsEmpty()); }

TEST(StrayPoses, AreZerosAloneOrTwoInARow) {
  std::vector<Pose2> poses = drive();
  poses[50] = poses[120] = poses[121] = Pose2{};
  EXPECT_THAT(stray_in(poses), ElementsAre(50U, 120U, 121U));
  const std::vector<StrayPose> found = stray_poses(poses);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[2].before, 119U);
  EXPECT_EQ(found[2].after, 122U);
}

TEST(StrayPoses, AreSpikesOfPositionOrHeading) {
  std::vector<Pose2> poses = drive();
  poses[30].y_m += 0.5;
  poses[60].heading_rad += 0.5;
  poses[90].heading_rad -= 3.0;
  poses[120] = poses[90];
  EXPECT_THAT(stray_in(poses), ElementsAre(30U, 60U, 90U, 120U));
}

TEST(StrayPoses, AreNoneWhereAJumpLasts) {
  std::vector<Pose2> poses = drive();
  for (std::size_t i = 100; i < poses.size(); ++i) poses[i].x_m += 40.0;
  for (std::size_t i = 150; i < poses.size(); ++i) poses[i].heading_rad += 1.0;
  EXPECT_THAT(stray_in(poses), IsEmpty());
}

TEST(StrayPoses, AreNoneWhereOdometryBeginsAnew) {
  std::vector<Pose2> poses = drive();
  for (std::size_t i = 100; i < poses.size(); ++i) poses[i] = {0.1 * (i - 100.0), 0.0, 0.0};
  EXPECT_THAT(stray_in(poses), IsEmpty());
}

TEST(StrayPoses, AreNoneOfARobotThatTurnsToAndFroBetweenScans) {
  std::vector<Pose2> poses = drive();
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i].heading_rad = i % 2 == 0 ? 0.0 : 0.9;
  EXPECT_THAT(stray_in(poses), IsEmpty());
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i].heading_rad = i % 7 == 0 ? 0.0 : 0.9;
  EXPECT_THAT(stray_in(poses), IsEmpty());
}

TEST(StrayPoses, AreNoneOfARobotThatGoesToAndFro) {
  std::vector<Pose2> poses = drive();
  for (std::size_t i = 0; i < poses.size(); ++i)
    poses[i].x_m = 5.0 + 0.1 * (i % 8 < 4 ? i % 8 : 8 - i % 8);
  EXPECT_THAT(stray_in(poses), IsEmpty());
}

TEST(StrayPoses, AreNoneOfTwoSourcesThatTakeTurns) {
  std::vector<Pose2> poses = drive();
  for (std::size_t i = 0; i < poses.size(); i += 5) poses[i].y_m += 10.0;
  EXPECT_THAT(stray_in(poses), IsEmpty());
}

}  // namespace
}  // namespace slammot::sensing
