#include "common/sensing/floor_survey.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace slammot::sensing {
namespace {

using geometry::Pose2;
using geometry::Vector2;

constexpr std::size_t kHalfCircleBeams = 181;
constexpr double kFloorDegree = std::numbers::pi / 180.0;
constexpr double kNoFloor = std::numeric_limits<double>::infinity();
constexpr float kTellsNothing = 0.001F;
const SurveyedBeams kHalfCircle{-90.0 * kFloorDegree, kFloorDegree, 0.0, 1.0, 80.0};

double floor_angle_of(std::size_t beam) {
  return kHalfCircle.first_beam_rad + kFloorDegree * static_cast<double>(beam);
}

double range_along(double inverse_per_m) {
  return inverse_per_m > 0.0 ? 1.0 / inverse_per_m : kNoFloor;
}

/// A rectangular hall. The floor is the line floor . (x, y) = 1 in the scanner's frame.
struct FloorHall {
  Vector2 floor{0.0, 0.0};
  double sway = 0.0;           ///< One sigma of the floor's inverse distance, relative.
  Vector2 hall_m{15.0, 10.0};  ///< Half length and half width.
};

class TiltedScanner {
 public:
  explicit TiltedScanner(const FloorHall& hall) : hall_(hall) {}

  std::vector<float> scan(const Pose2& world_from_laser) {
    const Vector2 now = hall_.floor * (1.0 + hall_.sway * noise_(random_));
    std::vector<float> readings;
    for (std::size_t beam = 0; beam < kHalfCircleBeams; ++beam) {
      const Vector2 direction(std::cos(floor_angle_of(beam)), std::sin(floor_angle_of(beam)));
      const double range_m =
          std::min(range_along(now.dot(direction)), range_of_walls_m(world_from_laser, direction));
      readings.push_back(static_cast<float>(range_m + 0.01 * noise_(random_)));
    }
    return readings;
  }

  /// Drives in curves.
  Pose2 pose(int step) const {
    const double s = 0.1 * step;
    return {0.6 * hall_.hall_m.x() * std::sin(0.31 * s),
            0.6 * hall_.hall_m.y() * std::sin(0.43 * s), geometry::wrap_angle(0.7 * s)};
  }

 private:
  double range_of_walls_m(const Pose2& world_from_laser, const Vector2& direction) const {
    const Vector2 in_world = geometry::rotation(world_from_laser.heading_rad) * direction;
    double range_m = kNoFloor;
    for (int axis = 0; axis < 2; ++axis) {
      const double place_m = world_from_laser.translation_m()[axis];
      const double wall_m = in_world[axis] > 0.0 ? hall_.hall_m[axis] : -hall_.hall_m[axis];
      if (in_world[axis] != 0.0) range_m = std::min(range_m, (wall_m - place_m) / in_world[axis]);
    }
    return range_m;
  }

  FloorHall hall_;
  std::mt19937 random_{3};
  std::normal_distribution<double> noise_;
};

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
