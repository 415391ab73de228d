#include "common/traffic/traffic_map.hpp"

#include <gtest/gtest.h>

#include "tests/unit/common/traffic/passages.hpp"

namespace slammot::traffic {
namespace {

std::vector<PlacedStream> streams_at(const TrafficMap& map, const Vector2& place_m,
                                     Mover mover = Mover::kVehicle) {
  std::vector<PlacedStream> found;
  for (const PlacedStream& placed : map.streams(mover)) {
    if ((placed.position_m - place_m).cwiseAbs().maxCoeff() < 0.5 * kCellM) found.push_back(placed);
  }
  return found;
}

double weight_of(const TrafficMap& map) {
  double weight = 0.0;
  for (const PlacedStream& placed : map.streams(Mover::kVehicle))
    weight += static_cast<double>(placed.stream->weight);
  return weight;
}

TEST(TrafficMap, CountsEachTrackOnceInACell) {
  TrafficMap map;
  for (int i = 0; i < 3; ++i) map.add(straight({0.0, 0.3}, {20.0, 0.3}, 1.0));
  const auto found = streams_at(map, {10.25, 0.3});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].stream->passages, 3U);
  EXPECT_NEAR(found[0].stream->length_m, 3.0 * kCellM, 0.3);
}

TEST(TrafficMap, KnowsMeanAndSpreadOfTheSpeed) {
  TrafficMap map;
  map.add(straight({0.0, 0.3}, {20.0, 0.3}, 8.0));
  map.add(straight({0.0, 0.3}, {20.0, 0.3}, 12.0));
  const auto found = streams_at(map, {10.25, 0.3});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].stream->speed_mps(), 10.0, 0.3);
  EXPECT_NEAR(found[0].stream->speed_spread_mps(), 2.0, 0.1);
}

TEST(TrafficMap, KeepsTheDirectionsOfACrossingApart) {
  TrafficMap map;
  map.add(straight({0.0, 10.2}, {20.0, 10.2}));
  map.add(straight({20.0, 10.2}, {0.0, 10.2}));
  map.add(straight({10.2, 0.0}, {10.2, 20.0}));
  const auto found = streams_at(map, {10.2, 10.2});
  ASSERT_EQ(found.size(), 3U);
  for (const PlacedStream& placed : found) {
    EXPECT_NEAR(placed.stream->agreement(), 1.0, 1e-5);
    EXPECT_EQ(placed.stream->passages, 1U);
  }
}

TEST(TrafficMap, KeepsKindsApart) {
  TrafficMap map;
  Passage pedestrian = straight({0.0, 0.3}, {20.0, 0.3}, 1.5);
  pedestrian.mover = Mover::kPedestrian;
  map.add(pedestrian);
  EXPECT_TRUE(map.streams(Mover::kVehicle).empty());
  EXPECT_EQ(streams_at(map, {10.25, 0.3}, Mover::kPedestrian).size(), 1U);
}

TEST(TrafficMap, TakesNothingFromWhatStands) {
  TrafficMap map;
  Passage parked = straight({0.0, 0.0}, {20.0, 0.0});
  for (MoverState& state : parked.states) state.velocity_in_map_mps *= 0.01;
  map.add(parked);
  EXPECT_EQ(map.size(), 0U);
}

TEST(TrafficMap, TakesNothingFromATrackThatWentNowhere) {
  TrafficMap map;
  map.add(straight({0.0, 0.0}, {2.0, 0.0}));
  EXPECT_EQ(map.size(), 0U);
}

TEST(TrafficMap, TakesNothingFromASpeedThatItsCovarianceExplains) {
  TrafficMap map;
  Passage uncertain = straight({0.0, 0.0}, {20.0, 0.0});
  for (MoverState& state : uncertain.states) state.covariance *= 1e4;
  map.add(uncertain);
  EXPECT_EQ(map.size(), 0U);
}

TEST(TrafficMap, GivesUncertainStatesLessWeight) {
  TrafficMap certain;
  TrafficMap uncertain;
  Passage passage = straight({0.0, 0.0}, {20.0, 0.0});
  certain.add(passage);
  for (MoverState& state : passage.states) state.covariance.topLeftCorner<2, 2>() *= 100.0;
  uncertain.add(passage);
  EXPECT_LT(weight_of(uncertain), 0.3 * weight_of(certain));
}

TEST(TrafficMap, TakesNoWayFromAStepAcrossTheVelocity) {
  TrafficMap map;
  Passage passage = straight({0.0, 0.3}, {20.0, 0.3}, 10.0);
  for (std::size_t i = 10; i < passage.states.size(); ++i)
    passage.states[i].position_in_map_m.y() += 3.0;
  map.add(passage);
  EXPECT_TRUE(streams_at(map, {9.5, 1.8}).empty());
  EXPECT_EQ(streams_at(map, {15.25, 3.3}).size(), 1U);
}

TEST(TrafficMap, TakesNoWayFromTheTimeWithoutEchoes) {
  TrafficMap map;
  Passage passage = straight({0.0, 0.3}, {40.0, 0.3}, 10.0);
  passage.states.erase(passage.states.begin() + 11, passage.states.begin() + 29);
  map.add(passage);
  EXPECT_TRUE(streams_at(map, {20.25, 0.3}).empty());
  EXPECT_EQ(streams_at(map, {5.25, 0.3}).size(), 1U);
}

TEST(TrafficMap, CountsOnInItsCellsWhenItIsFull) {
  TrafficMap map(30);
  map.add(straight({0.0, 0.3}, {10.0, 0.3}));
  ASSERT_FALSE(map.is_full());
  map.add(straight({0.0, 5.3}, {1000.0, 5.3}));
  EXPECT_TRUE(map.is_full());
  EXPECT_EQ(map.size(), 30U);
  map.add(straight({0.0, 0.3}, {10.0, 0.3}));
  EXPECT_EQ(map.size(), 30U);
  EXPECT_EQ(streams_at(map, {5.25, 0.3}).at(0).stream->passages, 2U);
}

TEST(TrafficMap, FindsTheStreamsAboutAPlace) {
  TrafficMap map;
  map.add(straight({-30.0, -0.2}, {30.0, -0.2}));
  std::vector<PlacedStream> found;
  map.append_near(Mover::kVehicle, {-10.0, 0.0}, 3.0, found);
  std::size_t within = 0;
  for (const PlacedStream& placed : map.streams(Mover::kVehicle))
    within += std::abs(placed.position_m.x() + 10.0) <= 3.0 ? 1U : 0U;
  EXPECT_GE(found.size(), within);
  EXPECT_LT(found.size(), map.size() / 4);
}

}  // namespace
}  // namespace slammot::traffic
