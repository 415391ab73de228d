#include "common/matching/icp.hpp"

#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"
#include "tests/support/surfels.hpp"

namespace slammot::matching {
namespace {

using geometry::Pose2;
using geometry::Vector2;
using slammot::testing::points_seen;
using slammot::testing::PoseNear;
using slammot::testing::surfels_of;
using slammot::testing::World;

std::vector<PointPair> scattered_pairs(const Pose2& target_from_source, double noise_m,
                                       std::mt19937& random) {
  std::normal_distribution<double> normal;
  std::vector<PointPair> pairs;
  for (int i = 0; i < 50; ++i) {
    const Vector2 in_source_m(3.0 * normal(random), 2.0 * normal(random));
    pairs.push_back(
        {target_from_source * in_source_m + noise_m * Vector2(normal(random), normal(random)),
         in_source_m});
  }
  return pairs;
}

double squared_distances_m2(const std::vector<PointPair>& pairs, const Pose2& target_from_source) {
  double sum_m2 = 0.0;
  for (const PointPair& pair : pairs)
    sum_m2 += (target_from_source * pair.in_source_m - pair.in_target_m).squaredNorm();
  return sum_m2;
}

TEST(AlignPairs, FindsTheMotionExactlyHoweverLargeItIs) {
  std::mt19937 random(1);
  for (const Pose2& truth : {Pose2{},
                             {1.0, -2.0, 0.3},
                             {-40.0, 7.0, 3.0},
                             {5.0, 5.0, -1.7},
                             {0.0, 0.0, std::numbers::pi}}) {
    EXPECT_THAT(align_pairs(scattered_pairs(truth, 0.0, random)), PoseNear(truth, 1e-9));
  }
}

TEST(AlignPairs, IsWhereTheSumOfSquaresIsLeast) {
  std::mt19937 random(2);
  const auto pairs = scattered_pairs({1.0, -2.0, 0.3}, 0.5, random);
  const Pose2 best = align_pairs(pairs);
  const double least_m2 = squared_distances_m2(pairs, best);
  for (const double sign : {-1.0, 1.0}) {
    for (const Pose2& step :
         {Pose2{0.01, 0.0, 0.0}, {0.0, 0.01, 0.0}, {0.0, 0.0, 0.01}, {0.01, -0.01, 0.005}}) {
      const Pose2 beside{best.x_m + sign * step.x_m, best.y_m + sign * step.y_m,
                         best.heading_rad + sign * step.heading_rad};
      EXPECT_LT(least_m2, squared_distances_m2(pairs, beside));
    }
  }
}

TEST(AlignPairs, FindsTheInverseWhenTheSidesChange) {
  std::mt19937 random(3);
  auto pairs = scattered_pairs({1.0, -2.0, 0.3}, 0.2, random);
  const Pose2 forward = align_pairs(pairs);
  for (PointPair& pair : pairs) std::swap(pair.in_source_m, pair.in_target_m);
  EXPECT_THAT(forward * align_pairs(pairs), PoseNear(Pose2{}, 1e-9));
}

TEST(AlignPairs, MovesAndTurnsWithTheTarget) {
  std::mt19937 random(4);
  auto pairs = scattered_pairs({1.0, -2.0, 0.3}, 0.2, random);
  const Pose2 here = align_pairs(pairs);
  const Pose2 there_from_here{13.0, -4.0, 2.2};
  for (PointPair& pair : pairs) pair.in_target_m = there_from_here * pair.in_target_m;
  EXPECT_THAT(align_pairs(pairs), PoseNear(there_from_here * here, 1e-9));
}

TEST(AlignPairs, KeepsOnePairUnturnedAndNoPairsWhereTheyAre) {
  EXPECT_EQ(align_pairs({}), Pose2{});
  const std::vector<PointPair> one = {{{3.0, 4.0}, {1.0, 1.0}}};
  EXPECT_EQ(align_pairs(one), (Pose2{2.0, 3.0, 0.0}));
}

std::vector<MatchPoint> exact_scan_of(const World& world, const Pose2& world_from_base) {
  std::mt19937 unused;
  return points_seen(world, world_from_base, 360, 0.0, unused);
}

TEST(MatchByIcp, FindsThePoseFromAllAroundToAFractionOfACell) {
  const World room = slammot::testing::room();
  const auto surfels = surfels_of(room);
  const Pose2 truth{-2.0, 1.0, 0.6};
  for (const Pose2& error :
       {Pose2{0.2, 0.0, 0.0}, {-0.2, 0.1, 0.0}, {0.0, -0.2, 0.03}, {0.0, 0.0, 0.05}}) {
    EXPECT_THAT(match_by_icp(exact_scan_of(room, truth), surfels, truth * error, {}).map_from_base,
                PoseNear(truth, 0.04));
  }
}

TEST(MatchByIcp, MovesAndTurnsWithTheWorld) {
  const World room = slammot::testing::room();
  const Pose2 truth{-2.0, 1.0, 0.6};
  const Pose2 there_from_here{13.37, -4.2, 1.1};
  const auto surfels =
      surfels_of(slammot::testing::moved(room, there_from_here), there_from_here.translation_m());
  const auto result = match_by_icp(exact_scan_of(room, truth), surfels,
                                   there_from_here * truth * Pose2{0.1, -0.1, 0.02}, {});
  EXPECT_THAT(result.map_from_base, PoseNear(there_from_here * truth, 0.04));
}

TEST(MatchByIcp, GivesTheInitialPoseWhereNothingMatches) {
  const Pose2 initial{30.0, 2.0, 0.3};
  const auto far_away =
      surfels_of(slammot::testing::moved(slammot::testing::room(), {-20.0, 0.0, 0.0}));
  const auto result =
      match_by_icp(exact_scan_of(slammot::testing::room(), {}), far_away, initial, {});
  EXPECT_EQ(result.map_from_base, initial);
  EXPECT_EQ(result.matched_points, 0);
  EXPECT_EQ(match_by_icp({}, far_away, initial, {}).map_from_base, initial);
}

}  // namespace
}  // namespace slammot::matching
