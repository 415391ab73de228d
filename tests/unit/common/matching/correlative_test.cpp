#include "common/matching/correlative.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"

namespace slammot::matching {
namespace {

using geometry::Pose2;
using geometry::Vector2;
using slammot::testing::PoseNear;

std::vector<Vector2> wall(const Vector2& from, const Vector2& to, double spacing_m = 0.07) {
  std::vector<Vector2> points;
  const int steps = static_cast<int>((to - from).norm() / spacing_m);
  for (int i = 0; i <= steps; ++i) points.push_back(from + (to - from) * i / steps);
  return points;
}

std::vector<Vector2> joined(const std::vector<std::vector<Vector2>>& parts) {
  std::vector<Vector2> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// A room of 12 x 8 m with a recess and a pillar: looks like itself from one pose only.
std::vector<Vector2> room() {
  return joined({wall({-6, -4}, {6, -4}), wall({6, -4}, {6, 4}), wall({6, 4}, {2, 4}),
                 wall({2, 4}, {2, 5.5}), wall({2, 5.5}, {-1, 5.5}), wall({-1, 5.5}, {-1, 4}),
                 wall({-1, 4}, {-6, 4}), wall({-6, 4}, {-6, -4}), wall({3, -1}, {3.6, -1}),
                 wall({3.6, -1}, {3.6, -1.6})});
}

std::vector<TargetPoint> as_target(const std::vector<Vector2>& points) {
  std::vector<TargetPoint> target;
  for (const Vector2& p : points)
    target.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()), 1.0F});
  return target;
}

std::vector<Eigen::Vector2f> seen_from(const std::vector<Vector2>& points_in_target,
                                       const Pose2& target_from_source) {
  std::vector<Eigen::Vector2f> points;
  const Pose2 source_from_target = inverse(target_from_source);
  for (const Vector2& point : points_in_target)
    points.push_back((source_from_target * point).cast<float>());
  return points;
}

TargetRegion region_of(double half_m, double largest_shift_m) {
  return {.centre_m = Vector2::Zero(),
          .half_width_m = half_m,
          .half_height_m = half_m,
          .largest_shift_m = largest_shift_m};
}

/// Every pose of the window one after the other: the oracle of the branch and bound.
double best_score_by_brute_force(const CorrelativeMatcher& matcher, const CorrelativeConfig& config,
                                 std::span<const Eigen::Vector2f> points, const Pose2& initial,
                                 const SearchWindow& window) {
  const int columns = static_cast<int>(std::ceil(window.half_x_m / config.resolution_m - 1e-9));
  const int rows = static_cast<int>(std::ceil(window.half_y_m / config.resolution_m - 1e-9));
  const int turns =
      static_cast<int>(std::ceil(window.half_heading_rad / config.heading_step_rad - 1e-9));
  double best = 0.0;
  for (int turn = -turns; turn <= turns; ++turn) {
    for (int row = -rows; row <= rows; ++row) {
      for (int column = -columns; column <= columns; ++column) {
        best = std::max(
            best, matcher.score(points, {initial.x_m + config.resolution_m * column,
                                         initial.y_m + config.resolution_m * row,
                                         initial.heading_rad + config.heading_step_rad * turn}));
      }
    }
  }
  return best;
}

TEST(CorrelativeMatcher, FindsAPoseFarFromTheInitialOne) {
  CorrelativeMatcher matcher({});
  matcher.set_target(as_target(room()), region_of(12.0, 4.0));
  const Pose2 truth{1.3, -0.7, 0.9};
  const auto peaks =
      matcher.search(seen_from(room(), truth), {-1.0, 1.0, 0.0}, {4.0, 4.0, std::numbers::pi});
  ASSERT_EQ(peaks.size(), 1U);
  EXPECT_THAT(peaks.front().target_from_source, PoseNear(truth, 0.1));
  EXPECT_GT(peaks.front().score, 0.8);
}

TEST(CorrelativeMatcher, AgreesWithBruteForceOnRandomScenes) {
  CorrelativeConfig config;
  config.heading_step_rad = 0.03;
  config.min_score = 0.0;
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> place(-5.0, 5.0);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  CorrelativeMatcher matcher(config);
  for (int scene = 0; scene < 20; ++scene) {
    std::vector<Vector2> points;
    for (int i = 0; i < 60; ++i) points.emplace_back(place(random), place(random));
    matcher.set_target(as_target(points), region_of(4.0, 1.3));  // smaller than the scene: its
                                                                 // border is crossed
    const Pose2 truth{unit(random), unit(random), 0.3 * unit(random)};
    const Pose2 initial{truth.x_m + 0.8 * unit(random), truth.y_m + 0.8 * unit(random),
                        truth.heading_rad + 0.1 * unit(random)};
    const SearchWindow window{1.3, 0.9, 0.2};
    const auto source = seen_from(points, truth);
    const auto peaks = matcher.search(source, initial, window);
    ASSERT_EQ(peaks.size(), 1U);
    EXPECT_DOUBLE_EQ(peaks.front().score,
                     best_score_by_brute_force(matcher, config, source, initial, window));
    EXPECT_DOUBLE_EQ(peaks.front().score, matcher.score(source, peaks.front().target_from_source));
  }
}

TEST(CorrelativeMatcher, MovesItsAnswerWithTheTarget) {
  const Pose2 moved_from_target{103.0, -58.0, 2.1};
  std::vector<Vector2> moved;
  for (const Vector2& point : room()) moved.push_back(moved_from_target * point);
  const Pose2 truth{0.4, 0.3, -0.2};
  CorrelativeMatcher matcher({});
  TargetRegion region = region_of(12.0, 1.0);
  region.centre_m = moved_from_target.translation_m();
  matcher.set_target(as_target(moved), region);
  const auto peaks = matcher.search(seen_from(room(), truth), moved_from_target, {1.0, 1.0, 0.4});
  ASSERT_EQ(peaks.size(), 1U);
  EXPECT_THAT(peaks.front().target_from_source, PoseNear(moved_from_target * truth, 0.1));
}

TEST(CorrelativeMatcher, GivesTheSameAnswerEveryTimeItIsAsked) {
  const auto source = seen_from(room(), {0.4, 0.3, -0.2});
  CorrelativeMatcher used({});
  used.set_target(as_target(joined({wall({-3, -3}, {3, 3})})), region_of(20.0, 2.0));
  used.search(source, {}, {2.0, 2.0, 0.5});
  used.set_target(as_target(room()), region_of(12.0, 1.0));
  CorrelativeMatcher fresh({});
  fresh.set_target(as_target(room()), region_of(12.0, 1.0));
  const auto from_used = used.search(source, {}, {1.0, 1.0, 0.4});
  const auto from_fresh = fresh.search(source, {}, {1.0, 1.0, 0.4});
  ASSERT_EQ(from_used.size(), from_fresh.size());
  EXPECT_EQ(from_used.front().target_from_source, from_fresh.front().target_from_source);
  EXPECT_EQ(from_used.front().score, from_fresh.front().score);
}

TEST(CorrelativeMatcher, ReportsBothPosesOfAPlaceThatLooksTheSameTurnedRound) {
  const auto rectangle = joined({wall({-6, -4}, {6, -4}), wall({6, -4}, {6, 4}),
                                 wall({6, 4}, {-6, 4}), wall({-6, 4}, {-6, -4})});
  CorrelativeConfig config;
  config.max_peaks = 5;
  config.min_peak_ratio = 0.9;
  CorrelativeMatcher matcher(config);
  matcher.set_target(as_target(rectangle), region_of(10.0, 1.0));
  const auto peaks = matcher.search(seen_from(rectangle, {}), {}, {1.0, 1.0, std::numbers::pi});
  ASSERT_GE(peaks.size(), 2U);
  const double turned = geometry::wrap_angle(peaks[0].target_from_source.heading_rad -
                                             peaks[1].target_from_source.heading_rad);
  EXPECT_NEAR(std::abs(turned), std::numbers::pi, 0.03);
  EXPECT_NEAR(peaks[0].score, peaks[1].score, 0.05);
}

TEST(CorrelativeMatcher, ReportsOnePeakWhereThePlaceIsUnique) {
  CorrelativeConfig config;
  config.max_peaks = 5;
  config.min_peak_ratio = 0.8;
  CorrelativeMatcher matcher(config);
  matcher.set_target(as_target(room()), region_of(12.0, 2.0));
  EXPECT_EQ(matcher.search(seen_from(room(), {}), {}, {2.0, 2.0, 0.5}).size(), 1U);
}

TEST(CorrelativeMatcher, FindsNothingWhereNothingFits) {
  CorrelativeConfig config;
  config.min_score = 0.6;
  CorrelativeMatcher matcher(config);
  matcher.set_target(as_target(wall({-6, -4}, {6, -4})), region_of(12.0, 1.0));
  EXPECT_TRUE(matcher.search(seen_from(room(), {}), {}, {1.0, 1.0, 0.3}).empty());
  EXPECT_TRUE(matcher.search({}, {}, {1.0, 1.0, 0.3}).empty());
}

TEST(CorrelativeMatcher, ScoresNothingFarOutsideItsRegion) {
  CorrelativeMatcher matcher({});
  matcher.set_target(as_target(room()), region_of(12.0, 1.0));
  EXPECT_EQ(matcher.score(seen_from(room(), {}), {1e12, -1e12, 0.0}), 0.0);
  EXPECT_TRUE(matcher.search(seen_from(room(), {}), {500.0, 0.0, 0.0}, {1.0, 1.0, 0.3}).empty());
}

TEST(CorrelativeMatcher, TrustsALighterTargetPointLess) {
  CorrelativeMatcher matcher({});
  auto target = as_target(room());
  for (TargetPoint& point : target) point.weight = 0.5F;
  matcher.set_target(target, region_of(12.0, 1.0));
  const double half = matcher.score(seen_from(room(), {}), {});
  EXPECT_GT(half, 0.45);
  EXPECT_LE(half, 0.5);
}

}  // namespace
}  // namespace slammot::matching
