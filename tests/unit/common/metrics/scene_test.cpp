#include "tests/unit/common/metrics/scenes.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace slammot::metrics {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
const CountingRule kRule;

TrueObject stopped_car_at(double x_m, double y_m, std::size_t object = 1) {
  TrueObject car = car_at(x_m, y_m, object);
  car.speed_mps = 0.0;
  return car;
}

TEST(DistanceToBox, IsZeroInsideAndTheWayToTheNearestEdgeOutside) {
  const TrueObject car = car_at(10.0, 0.0);
  EXPECT_EQ(distance_to_box_m({11.9, 0.9}, car), 0.0);
  EXPECT_NEAR(distance_to_box_m({13.0, 0.0}, car), 1.0, 1e-12);
  EXPECT_NEAR(distance_to_box_m({15.0, 5.0}, car), 5.0, 1e-12);  // 3 ahead, 4 aside
}

TEST(DistanceToBox, TurnsWithTheBox) {
  TrueObject car = car_at(0.0, 0.0);
  car.world_from_object.heading_rad = 0.5 * std::numbers::pi;
  EXPECT_NEAR(distance_to_box_m({0.0, 3.0}, car), 1.0, 1e-12);
}

TEST(DoesCount, NotWhatStandsIsFarOrIsHardlySeen) {
  const Scene scene;
  EXPECT_TRUE(does_count(car_at(10.0, 0.0), scene, kRule));
  EXPECT_FALSE(does_count(stopped_car_at(10.0, 0.0), scene, kRule));
  EXPECT_FALSE(does_count(car_at(51.0, 0.0), scene, kRule));
  TrueObject hardly_seen = car_at(10.0, 0.0);
  hardly_seen.points = 2;
  EXPECT_FALSE(does_count(hardly_seen, scene, kRule));
}

TEST(CountScene, LeavesOutWhatIsInDirectionsOfWhichTheTruthKnowsNothing) {
  CountingRule rule;
  rule.first_bearing_rad = -0.5, rule.last_bearing_rad = 0.2;
  const Scene scene{0,
                    {0.0, 0.0, 0.5 * std::numbers::pi},
                    {car_at(0.0, 20.0), car_at(-20.0, 0.0, 1)},
                    {track_at(5.0, 15.0), track_at(-15.0, 10.0, 1)}};
  const CountedScene counted = count_scene(scene, rule);
  EXPECT_EQ(counted.objects, std::vector<std::size_t>{0});  // ahead, not left
  EXPECT_EQ(counted.tracks, std::vector<std::size_t>{0});
}

TEST(CountScene, LeavesOutATrackOnAnObjectThatDoesNotCount) {
  const Scene scene{
      0, {}, {stopped_car_at(10.0, 0.0)}, {track_at(10.0, 0.5), track_at(12.9, 0.0, 1)}};
  const CountedScene counted = count_scene(scene, kRule);
  EXPECT_TRUE(counted.frame.objects.empty());
  EXPECT_TRUE(counted.frame.tracks.empty());  // neither its best track nor another within a metre
}

TEST(CountScene, KeepsATrackOnNothing) {
  const Scene scene{0, {}, {stopped_car_at(10.0, 0.0)}, {track_at(20.0, 0.0)}};
  EXPECT_EQ(count_scene(scene, kRule).frame.tracks.size(), 1U);
}

TEST(CountScene, DoesNotGiveTheTrackOfAStoppedCarToTheMovingOneBesideIt) {
  const Scene scene{0, {}, {car_at(10.0, 0.0), stopped_car_at(10.0, 3.0)}, {track_at(10.0, 3.0)}};
  const CountedScene counted = count_scene(scene, kRule);
  EXPECT_EQ(counted.frame.objects.size(), 1U);
  EXPECT_TRUE(counted.frame.tracks.empty());
}

TEST(CountScene, KeepsTheTrackOfACountedObjectThoughItStandsBesideOneThatDoesNot) {
  const Scene scene{0, {}, {car_at(10.0, 0.0), stopped_car_at(10.0, 2.5)}, {track_at(10.0, 0.9)}};
  EXPECT_EQ(count_scene(scene, kRule).frame.tracks.size(), 1U);
}

TEST(CountScene, LetsATrackJustOutOfRangeMatchAnObjectJustInside) {
  const Scene scene{0, {}, {car_at(49.9, 0.0)}, {track_at(50.2, 0.0), track_at(50.2, 10.0, 1)}};
  const CountedScene counted = count_scene(scene, kRule);
  ASSERT_EQ(counted.tracks.size(), 1U);
  EXPECT_EQ(counted.tracks[0], 0U);
}

TEST(CountScene, GivesTheSimilarityOfTheDistanceToTheBox) {
  const Scene scene{0, {}, {car_at(10.0, 0.0)}, {track_at(13.0, 0.0)}};
  EXPECT_NEAR(count_scene(scene, kRule).frame.similarity(0, 0), 0.75, 1e-12);
}

TEST(FillGaps, PutsAHiddenObjectOnTheLineBetween) {
  const std::vector<Scene> filled = fill_gaps({{0, {}, {car_at(0.0, 0.0)}, {}},
                                               {kSecondNs, {}, {}, {}},
                                               {4 * kSecondNs, {}, {car_at(40.0, 0.0)}, {}}},
                                              5 * kSecondNs);
  ASSERT_EQ(filled[1].objects.size(), 1U);
  EXPECT_NEAR(filled[1].objects[0].world_from_object.x_m, 10.0, 1e-12);
  EXPECT_EQ(filled[1].objects[0].points, 0);
}

TEST(FillGaps, LetsAnObjectBeGoneThatStaysHiddenForLong) {
  const std::vector<Scene> filled = fill_gaps({{0, {}, {car_at(0.0, 0.0)}, {}},
                                               {kSecondNs, {}, {}, {}},
                                               {9 * kSecondNs, {}, {car_at(40.0, 0.0)}, {}}},
                                              5 * kSecondNs);
  EXPECT_TRUE(filled[1].objects.empty());
}

}  // namespace
}  // namespace slammot::metrics
