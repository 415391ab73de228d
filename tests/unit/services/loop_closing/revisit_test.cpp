#include "services/loop_closing/revisit.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/floor_plan.hpp"
#include "tests/support/matchers.hpp"

namespace slammot::loop_closing {
namespace {

using geometry::Pose2;
using geometry::UncertainPose2;
using slammot::testing::FloorPlan;
using slammot::testing::PoseNear;
using slammot::testing::submap_seen_from;

RevisitConfig indoor_config() {
  RevisitConfig config;
  config.registration = {.fine_gate_m = 0.2, .surfel_sigma_m = 0.04};
  return config;
}

UncertainPose2 expected_about(const Pose2& pose, double position_sigma_m,
                              double heading_sigma_rad) {
  return {pose,
          Eigen::Vector3d(position_sigma_m * position_sigma_m, position_sigma_m * position_sigma_m,
                          heading_sigma_rad * heading_sigma_rad)
              .asDiagonal()};
}

/// Hall of 30 x 12 m with two different pillars.
FloorPlan hall() {
  FloorPlan plan;
  plan.add_box({-15, -6}, {15, 6});
  plan.add_box({2, 1}, {3, 2.5});
  plan.add_box({-6, -3}, {-4, -2.5});
  return plan;
}

/// Corridor of 60 m along x with a niche every 4 m: from within, each period looks like the next.
FloorPlan corridor_of_equal_niches() {
  FloorPlan plan;
  plan.add({-30, -1}, {30, -1});
  for (double x = -30; x < 30; x += 4.0) {
    plan.add({x, 1}, {x + 3, 1});
    plan.add({x + 3, 1}, {x + 3, 1.8});
    plan.add({x + 3, 1.8}, {x + 4, 1.8});
    plan.add({x + 4, 1.8}, {x + 4, 1});
  }
  return plan;
}

Place place_at(const FloorPlan& plan, std::uint32_t id, const Pose2& map_from_base,
               double reach_m = 12.0) {
  slammot::testing::SubmapMaker maker;
  maker.reach_m = reach_m;
  return make_place(
      submap_seen_from(plan, id, {map_from_base, map_from_base * Pose2{0.5, 0.0, 0.0}}, maker), 0.0,
      {.tolerance_m = 0.15});
}

TEST(FindRevisits, FindsAPlaceAgainFromSeveralMetresOff) {
  const Place earlier = place_at(hall(), 0, {});
  const Pose2 truth{-1.5, 1.0, 0.5};
  const Place later = place_at(hall(), 7, truth);
  const auto found = find_revisits(indoor_config(), {{{&earlier, Pose2::identity()}}}, later,
                                   expected_about(truth * Pose2{2.0, -1.5, 0.1}, 1.0, 0.1));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_THAT(found.front().from_to.pose, PoseNear(truth, 0.02));
  EXPECT_EQ(found.front().from, flow::SubmapId{0});
  EXPECT_EQ(found.front().to, flow::SubmapId{7});
  EXPECT_FALSE(found.front().has_rivals);
}

TEST(FindRevisits, UsesNeighboursOfThePlaceAsWell) {
  const Place earlier = place_at(hall(), 0, {-8, 0, 0}, 5.0);
  const Pose2 neighbour_pose{8, 0, 0};
  const Place neighbour = place_at(hall(), 1, neighbour_pose, 12.0);
  const Pose2 truth{9, 1, 0.3};
  const Place later = place_at(hall(), 7, truth, 7.5);
  const Pose2 first_from_map = inverse(Pose2{-8, 0, 0});
  const Target target{
      {{&earlier, Pose2::identity()}, {&neighbour, first_from_map * neighbour_pose}}};
  const auto found = find_revisits(indoor_config(), target, later,
                                   expected_about(first_from_map * truth, 0.5, 0.05));
  ASSERT_FALSE(found.empty());
  EXPECT_THAT(found.front().from_to.pose, PoseNear(first_from_map * truth, 0.02));
}

TEST(FindRevisits, FindsNothingInAnotherRoom) {
  FloorPlan other;
  other.add_box({-5, -9}, {8, 7});
  other.add_box({-2, 3}, {1, 3.5});
  const Place earlier = place_at(hall(), 0, {});
  const Place later = place_at(other, 7, {});
  EXPECT_TRUE(find_revisits(indoor_config(), {{{&earlier, Pose2::identity()}}}, later,
                            expected_about({}, 2.0, 0.2))
                  .empty());
}

TEST(FindRevisits, ReportsRivalsAmongEqualNiches) {
  std::vector<Pose2> way;
  for (double x = 0.0; x <= 12.0; x += 0.5) way.push_back({x, 0.0, 0.0});
  const Place earlier =
      make_place(submap_seen_from(corridor_of_equal_niches(), 0, way), 0.0, {.tolerance_m = 0.15});
  const Place later = place_at(corridor_of_equal_niches(), 7, {6.2, 0.0, 0.0}, 4.0);
  const auto found = find_revisits(indoor_config(), {{{&earlier, Pose2::identity()}}}, later,
                                   expected_about({6.0, 0.0, 0.0}, 2.0, 0.02));
  ASSERT_GE(found.size(), 2U);
  for (const Hypothesis& hypothesis : found) EXPECT_TRUE(hypothesis.has_rivals);
}

TEST(FindRevisits, HasAWideCovarianceAlongABareCorridorAndNoRivals) {
  FloorPlan corridor;
  corridor.add({-40, -1}, {40, -1});
  corridor.add({-40, 1}, {40, 1});
  const Place earlier = place_at(corridor, 0, {});
  const Place later = place_at(corridor, 7, {0.3, 0.0, 0.0}, 6.0);
  const auto found = find_revisits(indoor_config(), {{{&earlier, Pose2::identity()}}}, later,
                                   expected_about({}, 1.0, 0.02));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_GT(std::sqrt(found.front().from_to.covariance(0, 0)), 1.0);
  EXPECT_LT(std::sqrt(found.front().from_to.covariance(1, 1)), 0.1);
}

}  // namespace
}  // namespace slammot::loop_closing
