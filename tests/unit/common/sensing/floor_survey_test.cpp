#include "common/sensing/floor_survey.hpp"

#include <gtest/gtest.h>

#include "tests/support/tilted_scanner.hpp"

namespace slammot::sensing {
namespace {

using geometry::Pose2;
using testing::FloorHall;
using testing::kHalfCircle;
using testing::TiltedScanner;

constexpr float kTellsNothing = 0.001F;

FloorInView floor_after_a_drive(const FloorHall& hall, int steps = 1000) {
  TiltedScanner scanner(hall);
  FloorSurvey survey;
  for (int step = 0; step < steps; ++step)
    survey.add(scanner.scan(scanner.pose(step)), scanner.pose(step), false);
  return survey.conclude(kHalfCircle);
}

TEST(FloorSurvey, FindsTheLineAhead) {
  const FloorInView floor = floor_after_a_drive({.floor = {0.2, 0.0}});
  ASSERT_TRUE(floor.is_in_view());
  EXPECT_NEAR(floor.distance_m, 5.0, 0.1);
  EXPECT_NEAR(floor.bearing_rad, 0.0, 0.02);
  EXPECT_NEAR(floor.from[90], 4.8, 0.2) << "ahead, a little before it";
  EXPECT_NEAR(floor.from[150], 9.0, 1.0) << "60 degrees to the left";
  EXPECT_GT(floor.from[0], 50.0F) << "beside the scanner";
}

TEST(FloorSurvey, FindsNothingWithALevelScanner) {
  EXPECT_FALSE(floor_after_a_drive({}).is_in_view());
}

TEST(FloorSurvey, FindsALineThatSwaysWithThePitchAndLeavesOutAllOfIt) {
  const FloorInView floor = floor_after_a_drive({.floor = {0.2, 0.0}, .sway = 0.03});
  ASSERT_TRUE(floor.is_in_view());
  EXPECT_NEAR(floor.distance_m, 5.0, 0.3);
  EXPECT_LT(floor.from[90], 5.0 / 1.06);
}

TEST(FloorSurvey, FindsALineBesideAScannerThatIsTiltedToTheLeft) {
  const FloorInView floor = floor_after_a_drive({.floor = {0.05, 0.25}});
  ASSERT_TRUE(floor.is_in_view());
  EXPECT_NEAR(floor.bearing_rad, std::atan2(0.25, 0.05), 0.03);
}

/// A straight drive along a wall: a tilted scanner would see the same.
TEST(FloorSurvey, DoesNotTakeAWallBesideTheVehicleForTheFloor) {
  TiltedScanner scanner({.hall_m = {300.0, 5.0}});
  FloorSurvey survey;
  for (int step = 0; step < 500; ++step) {
    const Pose2 pose{0.5 * step - 125.0, 2.0, 0.0};
    survey.add(scanner.scan(pose), pose, false);
  }
  EXPECT_FALSE(survey.conclude(kHalfCircle).is_in_view());
}

/// Twice around a hall, in curves of 3 m: along its short walls, then along its long ones, which
/// are nearer.
std::vector<Pose2> poses_around_a_hall() {
  std::vector<Pose2> poses{{-8.0, -7.0, 0.0}};
  const auto go = [&](int steps, double turn_rad) {
    for (int i = 0; i < steps; ++i) poses.push_back(poses.back() * Pose2{0.3, 0.0, turn_rad});
  };
  const auto curve = [&] { go(15, 0.5 * std::numbers::pi / 15); };
  for (int side = 0; side < 8; ++side) {
    go(side % 2 == 0 ? 53 : 26, 0.0);
    curve();
  }
  return poses;
}

TEST(FloorSurvey, DoesNotTakeAWallForTheFloorThatIsAslantInTurns) {
  TiltedScanner scanner({.hall_m = {18.0, 12.0}});
  FloorSurvey survey;
  for (const Pose2& pose : poses_around_a_hall()) survey.add(scanner.scan(pose), pose, false);
  EXPECT_FALSE(survey.conclude(kHalfCircle).is_in_view());
}

TEST(FloorSurvey, DoesNotTakeAWallBeforeAVehicleThatStandsForTheFloor) {
  TiltedScanner scanner({});
  FloorSurvey survey;
  for (int step = 0; step < 1000; ++step) survey.add(scanner.scan({}), {}, false);
  EXPECT_FALSE(survey.conclude(kHalfCircle).is_in_view());
}

TEST(FloorSurvey, ReadsMillimetres) {
  TiltedScanner scanner({.floor = {0.2, 0.0}});
  FloorSurvey survey;
  for (int step = 0; step < 500; ++step) {
    std::vector<float> readings = scanner.scan(scanner.pose(step));
    for (float& reading : readings) reading *= 1000.0F;
    survey.add(readings, scanner.pose(step), false);
  }
  SurveyedBeams beams = kHalfCircle;
  beams.unit_m = 1e-3;
  EXPECT_NEAR(survey.conclude(beams).from[90], 4800.0, 200.0);
}

TEST(FloorInView, HidesWhatIsOnItOrBeyond) {
  const FloorInView floor{.from = {4.0F, 4.0F, std::numeric_limits<float>::infinity()}};
  std::vector<float> readings{3.9F, 4.1F, 4.1F};
  floor.hide(readings, kTellsNothing);
  EXPECT_EQ(readings, (std::vector<float>{3.9F, kTellsNothing, 4.1F}));
  std::vector<float> others{5.0F};
  floor.hide(others, kTellsNothing);
  EXPECT_EQ(others[0], 5.0F) << "a scan of another number of beams";
}

}  // namespace
}  // namespace slammot::sensing
