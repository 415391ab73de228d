#include "services/loop_closing/place.hpp"

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "tests/support/floor_plan.hpp"

namespace slammot::loop_closing {
namespace {

using geometry::Pose2;
using slammot::testing::FloorPlan;
using slammot::testing::submap_seen_from;

const PlaceConfig kConfig{.tolerance_m = 0.15};

FloorPlan room_with_pillar() {
  FloorPlan plan;
  plan.add_box({-6, -4}, {6, 4});
  plan.add_box({2, 1}, {3, 2.5});
  return plan;
}

Place place_of(const FloorPlan& plan, std::uint32_t id, const Pose2& map_from_base) {
  return make_place(submap_seen_from(plan, id, {map_from_base}), 0.0, kConfig);
}

TEST(MakePlace, MarksFreeOccupiedAndUnseenCells) {
  const Place place = place_of(room_with_pillar(), 0, {});
  EXPECT_EQ(place.state_at({-3.0, 1.0}), CellState::kFree);
  EXPECT_EQ(place.state_at({2.0, 1.5}), CellState::kOccupied);
  EXPECT_EQ(place.state_at({2.0 - 0.12, 1.5}), CellState::kOccupied);  // within the tolerance
  EXPECT_EQ(place.state_at({5.0, 3.5}), CellState::kUnknown);          // in the pillar's shadow
  EXPECT_EQ(place.state_at({1e9, -1e9}), CellState::kUnknown);
}

TEST(MakePlace, LeavesOutSurfelsSeenThroughOrWithFewEchoes) {
  flow::Submap submap = submap_seen_from(room_with_pillar(), 0, {Pose2{}});
  const std::size_t walls = make_place(submap, 0.0, kConfig).surfels.size();
  submap.surfels.push_back({-3.0F, 1.0F, 1.0F, 0.0F, 50.0F});
  submap.surfels.push_back({5.0F, 3.5F, 1.0F, 0.0F, 1.0F});
  EXPECT_EQ(make_place(submap, 0.0, kConfig).surfels.size(), walls);
}

/// A cell of this evidence [log-odds] at the origin of a submap that has nothing else.
CellState state_of_a_cell(double log_odds) {
  constexpr double kStepsPerLogOdds = 16.0;  // of flow::Submap::so_log_odds
  flow::Submap submap;
  submap.cell_size_m = 0.2;
  submap.min_x_m = submap.min_y_m = -0.1;
  submap.columns = submap.rows = 1;
  submap.so_log_odds = {static_cast<std::int8_t>(std::lround(kStepsPerLogOdds * log_odds))};
  return make_place(submap, 0.0, {}).state_at({0.0, 0.0});
}

TEST(MakePlace, KnowsACellBySevenTenthsOfProbabilityAndNotByLess) {
  const double seven_tenths = std::log(0.70 / 0.30);
  EXPECT_EQ(state_of_a_cell(seven_tenths), CellState::kOccupied);
  EXPECT_EQ(state_of_a_cell(-seven_tenths), CellState::kFree);
  const double hardly = std::log(0.65 / 0.35);
  EXPECT_EQ(state_of_a_cell(hardly), CellState::kUnknown);
  EXPECT_EQ(state_of_a_cell(-hardly), CellState::kUnknown);
}

TEST(MakePlace, SumsTheDistanceDriven) {
  const auto submap =
      submap_seen_from(room_with_pillar(), 0, {Pose2{0, 0, 0}, Pose2{1, 0, 0}, Pose2{2, 0, 0}});
  const Place place = make_place(submap, 100.0, kConfig);
  EXPECT_DOUBLE_EQ(place.travelled_before_m, 100.0);
  EXPECT_DOUBLE_EQ(place.travelled_after_m, 102.0);
  EXPECT_NEAR(place.centre_m.x(), 1.0, 1e-9);
}

TEST(Compare, AgreesWithItselfFromAnotherPose) {
  const Pose2 second{-2.0, 1.0, 0.7};
  const Place first_place = place_of(room_with_pillar(), 0, {});
  const Place second_place = place_of(room_with_pillar(), 1, second);
  const Agreement agreement = compare({{{&first_place, Pose2::identity()}}}, second_place, second);
  EXPECT_GT(agreement.agreed_share(), 0.97);
  EXPECT_GT(agreement.overlap_share(), 0.8);
}

TEST(Compare, CountsTheSameContradictionsWithSidesSwapped) {
  const Pose2 wrong{1.5, 0.7, 0.2};
  const Place a = place_of(room_with_pillar(), 0, {});
  const Place b = place_of(room_with_pillar(), 1, {-1.0, 0.5, 0.1});
  const Agreement forth = compare({{{&a, Pose2::identity()}}}, b, wrong);
  const Agreement back = compare({{{&b, Pose2::identity()}}}, a, inverse(wrong));
  EXPECT_EQ(forth.contradicted, back.contradicted);
  EXPECT_EQ(forth.occupied_in_both, back.occupied_in_both);
}

TEST(Compare, CountsAWallInFreeSpaceAsAContradiction) {
  const Place place = place_of(room_with_pillar(), 0, {});
  const Agreement shifted = compare({{{&place, Pose2::identity()}}}, place, {1.0, 0.0, 0.0});
  EXPECT_LT(shifted.agreed_share(), 0.8);
  EXPECT_GT(shifted.contradicted, 30);
}

}  // namespace
}  // namespace slammot::loop_closing
