#include "services/localization/whole_objects.hpp"

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slammot::localization {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kWidest_m = 1.2;
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

sensing::LaserScan scan_of(const std::vector<float>& range_m) {
  sensing::LaserScan scan;
  scan.scanner.beam_step_rad = 0.0087;
  scan.scanner.max_range_m = 50.0;
  scan.scanner.base_from_laser = {1.5, 0.0, 0.0};
  scan.range_m = range_m;
  return scan;
}

/// Beams of whole objects among beams half a degree apart.
std::vector<std::size_t> whole(WholeObjects& objects, const std::vector<float>& range_m) {
  const sensing::LaserScan scan = scan_of(range_m);
  std::vector<geometry::Vector2> points_m;
  for (std::size_t beam = 0; beam < range_m.size(); ++beam) {
    const double angle_rad = scan.scanner.beam_step_rad * static_cast<double>(beam);
    const auto distance_m = static_cast<double>(range_m[beam]);
    points_m.push_back(
        scan.scanner.base_from_laser *
        geometry::Vector2(distance_m * std::cos(angle_rad), distance_m * std::sin(angle_rad)));
  }
  objects.find(scan, points_m, 0.3, kWidest_m);
  std::vector<std::size_t> found;
  for (std::size_t beam = 0; beam < range_m.size(); ++beam)
    if (objects.width_m(beam) > 0.0) found.push_back(beam);
  return found;
}

/// Where echoes of this drive come from up to 30 m.
std::vector<std::size_t> whole(const std::vector<float>& range_m) {
  WholeObjects objects;
  objects.find(scan_of({30, 30, 30}), std::vector<geometry::Vector2>(3), 0.3, kWidest_m);
  return whole(objects, range_m);
}

TEST(WholeObjects, AreTrunksInFrontOfAWallOrOfNothing) {
  EXPECT_THAT(whole({20, 20, 9, 9, 9, 20, 20}), ElementsAre(2U, 3U, 4U));
  EXPECT_THAT(whole({kNone, 9, 9, kNone}), ElementsAre(1U, 2U));
  EXPECT_THAT(whole({60, 9, 60}), ElementsAre(1U));
}

TEST(WholeObjects, AreNotSeenThroughAGap) {
  EXPECT_THAT(whole({5, 9, 9, 9, 5}), IsEmpty());
  EXPECT_THAT(whole({20, 9, 9, 9, 5}), IsEmpty()) << "one end is behind something else";
  EXPECT_THAT(whole({5, 9, 9, 9, 20}), IsEmpty());
}

TEST(WholeObjects, HaveNoEndsWhereTheViewHas) {
  EXPECT_THAT(whole({9, 9, 20}), IsEmpty());
  EXPECT_THAT(whole({20, 9, 9}), IsEmpty());
}

TEST(WholeObjects, AreNarrow) {
  std::vector<float> wide(21, 9.0F);  // 1.5 m
  wide.front() = wide.back() = 20.0F;
  EXPECT_THAT(whole(wide), IsEmpty());
  std::vector<float> narrow(15, 9.0F);  // 0.94 m
  narrow.front() = narrow.back() = 20.0F;
  EXPECT_EQ(whole(narrow).size(), 13U);
}

TEST(WholeObjects, AreAsWideAsTheyAreSeenAndAGapMore) {
  WholeObjects objects;
  objects.find(scan_of({30, 30, 30}), std::vector<geometry::Vector2>(3), 0.3, kWidest_m);
  ASSERT_THAT(whole(objects, {20, 10, 10, 10, 20}), ElementsAre(1U, 2U, 3U));
  EXPECT_NEAR(objects.width_m(2), 3 * 0.087, 0.001);
  EXPECT_EQ(objects.points(2), 3.0);
  EXPECT_EQ(objects.width_m(0), 0.0);
}

TEST(WholeObjects, AreNoPiecesOfAWallBetweenDropOuts) {
  std::vector<float> wall(60, 9.0F);
  for (std::size_t beam = 3; beam < wall.size(); beam += 4) wall[beam] = kNone;
  EXPECT_THAT(whole(wall), IsEmpty());
}

TEST(WholeObjects, AreNotLookedForUnlessAsked) {
  WholeObjects objects;
  const std::vector<float> trunk = {20, 9, 20};
  objects.find(scan_of(trunk), std::vector<geometry::Vector2>(3), 0.3, 0.0);
  EXPECT_EQ(objects.width_m(1), 0.0);
}

TEST(WholeObjects, AreNotCutOffByTheRange) {
  WholeObjects objects;  // nothing answers from beyond 9 m
  EXPECT_THAT(whole(objects, {9, 9, 9, kNone, 8.5, 8.5, kNone, 7, 7, kNone}), ElementsAre(7U, 8U));
}

TEST(WholeObjects, AreNotBesideWhatIsTooNearToBeEchoes) {
  EXPECT_THAT(whole({0.1F, 9, 9, 20}), IsEmpty());
}

TEST(WholeObjects, AreOfTheScanThatWasLookedAtLast) {
  EXPECT_THAT(whole({}), IsEmpty());
  EXPECT_THAT(whole({20, 9, 20, 20, 7, 7, 20}), ElementsAre(1U, 4U, 5U));
}

}  // namespace
}  // namespace slammot::localization
