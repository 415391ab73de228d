#include "common/metrics/object_errors.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/common/metrics/scenes.hpp"

namespace slammot::metrics {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
const CountingRule kRule;

ObjectErrorTables tables_of(const std::vector<Scene>& scenes, std::size_t objects,
                            std::size_t tracks) {
  std::vector<CountedScene> counted;
  MotSequence sequence{objects, tracks, {}};
  for (const Scene& scene : scenes) {
    counted.push_back(count_scene(scene, kRule));
    sequence.frames.push_back(counted.back().frame);
  }
  return object_errors(scenes, counted, clear_mot(sequence, 0.5), {0.0, 20.0}, 50.0);
}

TEST(ObjectErrors, AreTheDifferencesOfTheMatchedRows) {
  ReportedTrack track = track_at(10.3, 0.4);
  track.velocity_in_world_mps = {9.0, 0.0};
  track.world_from_object.heading_rad = 0.1;
  track.length_m = 3.0;
  const ObjectErrors errors = tables_of({{0, {}, {car_at(10.0, 0.0)}, {track}}}, 1, 1).all;
  EXPECT_NEAR(errors.centre_m.rmse, 0.5, 1e-12);
  EXPECT_NEAR(errors.velocity_mps.rmse, 1.0, 1e-12);
  EXPECT_NEAR(errors.heading_rad.rmse, 0.1, 1e-12);
  EXPECT_NEAR(errors.length_m.rmse, 1.0, 1e-12);
  EXPECT_NEAR(errors.width_m.rmse, 0.0, 1e-12);
  EXPECT_EQ(errors.recall, 1.0);
  EXPECT_EQ(errors.right_class, 1.0);
}

TEST(ObjectErrors, CountTheDelayFromTheFirstRowThatCounted) {
  const ObjectErrorTables tables =
      tables_of({{0, {}, {car_at(10.0, 0.0), car_at(30.0, 9.0, 1)}, {}},
                 {kSecondNs, {}, {car_at(10.0, 0.0), car_at(30.0, 9.0, 1)}, {track_at(10.0, 0.0)}}},
                2, 1);
  EXPECT_EQ(tables.detection_delay_s.count, 1U);
  EXPECT_NEAR(tables.detection_delay_s.median, 1.0, 1e-12);
  EXPECT_EQ(tables.never_detected, 1U);
}

TEST(ObjectErrors, AreSplitByClassAndDistance) {
  TrueObject bus = car_at(30.0, 0.0, 1);
  bus.object_class = "bus";
  const ObjectErrorTables tables = tables_of(
      {{0, {}, {car_at(10.0, 0.0), bus}, {track_at(10.0, 0.0), track_at(40.0, 9.0, 1)}}}, 2, 2);
  EXPECT_EQ(tables.by_class.at("car").recall, 1.0);
  EXPECT_EQ(tables.by_class.at("bus").recall, 0.0);
  EXPECT_EQ(tables.by_distance[0].errors.matched_rows, 1U);
  EXPECT_EQ(tables.by_distance[1].errors.rows, 1U);
  EXPECT_EQ(tables.by_distance[1].false_rows, 1U);
}

TEST(ObjectErrors, TellForWhatEachClassWasTaken) {
  ReportedTrack mistaken = track_at(10.0, 0.0);
  mistaken.object_class = "bicycle";
  const ObjectErrors errors = tables_of({{0, {}, {car_at(10.0, 0.0)}, {track_at(10.0, 0.0)}},
                                         {kSecondNs, {}, {car_at(10.0, 0.0)}, {mistaken}}},
                                        1, 1)
                                  .by_class.at("car");
  EXPECT_EQ(errors.reported_as, (std::map<std::string, std::size_t>{{"bicycle", 1}, {"car", 1}}));
  EXPECT_EQ(errors.right_class, 0.5);
}

TEST(ObjectErrors, TakeOneNeesSampleASecond) {
  ReportedTrack track = track_at(10.2, 0.0);
  track.position_covariance_m2 = geometry::Matrix2::Identity() * 0.01;
  std::vector<Scene> scenes;
  for (int i = 0; i < 21; ++i)
    scenes.push_back({i * kSecondNs / 10, {}, {car_at(10.0, 0.0)}, {track}});
  const NeesSummary nees = tables_of(scenes, 1, 1).all.position_nees;
  EXPECT_EQ(nees.samples, 3U);
  EXPECT_NEAR(nees.mean, 4.0, 1e-9);  // two standard deviations
}

TEST(IsSameClass, KnowsThatTrucksAndBusesAreOne) {
  EXPECT_TRUE(is_same_class("bus", "truck_or_bus"));
  EXPECT_TRUE(is_same_class("truck", "truck_or_bus"));
  EXPECT_FALSE(is_same_class("car", "truck_or_bus"));
  EXPECT_TRUE(is_same_class("car", "car"));
}

}  // namespace
}  // namespace slammot::metrics
