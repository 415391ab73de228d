#include "services/loop_closing/loop_closer.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/floor_plan.hpp"
#include "tests/support/matchers.hpp"

namespace slammot::loop_closing {
namespace {

using flow::GraphCorrection;
using flow::Submap;
using flow::SubmapId;
using geometry::Pose2;
using slammot::testing::FloorPlan;
using slammot::testing::PoseNear;
using slammot::testing::submap_seen_from;

LoopClosingConfig indoor_config() {
  LoopClosingConfig config;
  config.min_travel_between_m = 15.0;
  config.max_distance_m = 10.0;
  config.sure_within_m = 1.0;
  config.place.tolerance_m = 0.15;
  config.revisit.search_cell_m = 0.1;
  config.revisit.min_window_m = 0.5;
  config.revisit.registration = {.coarse_gate_m = 0.5, .fine_gate_m = 0.2, .surfel_sigma_m = 0.04, .independent_spacing_m = 0.5};
  return config;
}

/// Ring of corridors, 2 m wide, around a block of 20 x 20 m; niches and pillars make every place its own.
FloorPlan ring() {
  FloorPlan plan;
  plan.add_box({0, 0}, {20, 20});
  plan.add_box({-2, -2}, {22, 22});
  plan.add_box({3.0, -1.9}, {3.6, -1.5});
  plan.add_box({9.0, -0.4}, {9.8, -0.1});
  plan.add_box({21.3, 4.0}, {21.9, 5.5});
  plan.add_box({20.1, 12.0}, {20.5, 12.6});
  plan.add_box({15.0, 21.2}, {16.0, 21.9});
  plan.add_box({6.0, 20.1}, {6.5, 20.7});
  plan.add_box({-1.9, 16.0}, {-1.2, 16.5});
  plan.add_box({-0.5, 7.0}, {-0.1, 8.2});
  return plan;
}

/// Poses half a metre apart along the middle of the ring's corridors, rounds times about.
std::vector<Pose2> way_around_the_ring(double rounds) {
  std::vector<Pose2> way;
  Pose2 pose{-1.0, -1.0, 0.0};
  const int steps = static_cast<int>(rounds * 168.0);
  for (int i = 0; i < steps; ++i) {
    way.push_back(pose);
    const bool at_corner = (i + 1) % 44 == 0;
    pose = pose * Pose2{0.5, 0.0, 0.0};
    if (at_corner) pose = pose * Pose2{0.0, 0.0, std::numbers::pi / 2};
  }
  return way;
}

/// The drive cut into submaps of six metres, as a front end saw it whose heading bends by bend_rad_per_m.
std::vector<Submap> drive(const FloorPlan& plan, const std::vector<Pose2>& map_from_base, double bend_rad_per_m, double sigma_scale = 1.0) {
  constexpr std::size_t kPoses = 12;
  std::vector<Submap> submaps;
  Pose2 odom_from_submap;
  for (std::size_t first = 0; first + kPoses < map_from_base.size(); first += kPoses) {
    const auto begin = map_from_base.begin() + static_cast<std::ptrdiff_t>(first);
    Submap submap = submap_seen_from(plan, static_cast<std::uint32_t>(submaps.size()), {begin, begin + kPoses + 1});
    if (!submaps.empty()) {
      const Pose2 step = submaps.back().submap_from_base_at_end * Pose2{0.0, 0.0, bend_rad_per_m * submaps.back().travelled_m};
      const double position_sigma_m = sigma_scale * 0.05;
      const double heading_sigma_rad = sigma_scale * 0.015;
      submap.previous_from_submap = {step, Eigen::Vector3d(position_sigma_m * position_sigma_m, position_sigma_m * position_sigma_m, heading_sigma_rad * heading_sigma_rad).asDiagonal()};
      odom_from_submap = odom_from_submap * step;
    }
    submap.odom_from_submap = odom_from_submap;
    submaps.push_back(submap);
  }
  return submaps;
}

double largest_error_m(const GraphCorrection& correction, const std::vector<Pose2>& map_from_base) {
  double largest_m = 0.0;
  for (const auto& node : correction.submaps) {
    const Pose2 truth = inverse(map_from_base.front()) * map_from_base[12 * node.submap_id.value];
    largest_m = std::max(largest_m, (node.map_from_submap.translation_m() - truth.translation_m()).norm());
  }
  return largest_m;
}

TEST(LoopCloser, ClosesARoundWhoseOdometryBends) {
  const auto way = way_around_the_ring(1.3);
  const auto submaps = drive(ring(), way, 0.002);
  LoopCloser closer(indoor_config());
  GraphCorrection correction;
  for (const Submap& submap : submaps) correction = closer.add(submap);
  GraphCorrection uncorrected;
  for (const Submap& submap : submaps) uncorrected.submaps.push_back({submap.submap_id, submap.odom_from_submap});
  EXPECT_GT(largest_error_m(uncorrected, way), 1.5);
  EXPECT_GE(closer.counters().closures, 2U);
  EXPECT_LT(largest_error_m(correction, way), 0.3);
}

TEST(LoopCloser, SaysWhereEverySubmapIsEachTimeOneCameIn) {
  const auto submaps = drive(ring(), way_around_the_ring(0.4), 0.0);
  LoopCloser closer(indoor_config());
  for (std::size_t i = 0; i < submaps.size(); ++i) {
    const GraphCorrection correction = closer.add(submaps[i]);
    EXPECT_EQ(correction.sequence, i + 1);
    ASSERT_EQ(correction.submaps.size(), i + 1);
    EXPECT_THAT(correction.submaps.front().map_from_submap, PoseNear(submaps.front().odom_from_submap, 1e-12));
    EXPECT_THAT(correction.map_from_odom * submaps[i].odom_from_submap, PoseNear(correction.submaps.back().map_from_submap, 1e-9));
  }
}

TEST(LoopCloser, IgnoresASubmapThatItKnows) {
  const auto submaps = drive(ring(), way_around_the_ring(0.4), 0.0);
  LoopCloser closer(indoor_config());
  for (const Submap& submap : submaps) closer.add(submap);
  const std::size_t constraints = closer.constraints().size();
  EXPECT_EQ(closer.add(submaps[1]).submaps.size(), submaps.size());
  EXPECT_EQ(closer.constraints().size(), constraints);
  EXPECT_EQ(closer.counters().repeated_submaps, 1U);
}

TEST(LoopCloser, BridgesASubmapThatWasLost) {
  const auto submaps = drive(ring(), way_around_the_ring(0.5), 0.0);
  LoopCloser closer(indoor_config());
  GraphCorrection correction;
  for (const Submap& submap : submaps) {
    if (submap.submap_id != SubmapId{2}) correction = closer.add(submap);
  }
  ASSERT_EQ(correction.submaps.size(), submaps.size() - 1);
  EXPECT_THAT(correction.submaps.back().map_from_submap, PoseNear(submaps.back().odom_from_submap, 1e-6));
}

TEST(LoopCloser, GivesTheSameBitsTwice) {
  const auto submaps = drive(ring(), way_around_the_ring(1.2), 0.002);
  LoopCloser first(indoor_config());
  LoopCloser second(indoor_config());
  for (const Submap& submap : submaps) {
    const GraphCorrection a = first.add(submap);
    const GraphCorrection b = second.add(submap);
    for (std::size_t i = 0; i < a.submaps.size(); ++i) ASSERT_EQ(a.submaps[i].map_from_submap, b.submaps[i].map_from_submap);
  }
}

TEST(LoopCloser, DoesNotTakeOneOfEqualCorridorsForAnother) {
  // Straight on past door after door, each like the last, with an odometry that admits to being metres off.
  FloorPlan plan;
  for (double x = -20.0; x < 140.0; x += 5.0) {
    plan.add({x, -1}, {x + 4, -1});
    plan.add({x + 4, -1}, {x + 4, -1.5});
    plan.add({x + 4, -1.5}, {x + 5, -1.5});
    plan.add({x + 5, -1.5}, {x + 5, -1});
    plan.add({x, 1}, {x + 5, 1});
  }
  std::vector<Pose2> way;
  for (int i = 0; i < 240; ++i) way.push_back({0.5 * i, 0.0, 0.0});
  LoopClosingConfig config = indoor_config();
  config.max_distance_m = 40.0;
  LoopCloser closer(config);
  for (const Submap& submap : drive(plan, way, 0.0, 4.0)) closer.add(submap);
  EXPECT_GT(closer.counters().searches, 10U);
  EXPECT_EQ(closer.counters().closures, 0U);
}

}  // namespace
}  // namespace slammot::loop_closing
