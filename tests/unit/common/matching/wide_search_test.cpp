#include "common/matching/wide_search.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"

namespace slammot::matching {
namespace {

using geometry::Pose2;
using geometry::Vector2;
using slammot::testing::PoseNear;

constexpr double kCellM = 0.1;

void append_wall(std::vector<Vector2>& points, const Vector2& from, const Vector2& to) {
  const int steps = static_cast<int>((to - from).norm() / 0.1);
  for (int i = 0; i <= steps; ++i) points.push_back(from + (to - from) * i / steps);
}

/// A room of 12 x 8 m with a recess and a pillar: looks like itself from one pose only.
std::vector<Vector2> room() {
  std::vector<Vector2> points;
  const std::vector<Vector2> corners{{-6, -4},  {6, -4}, {6, 4},  {2, 4},  {2, 5.5},
                                     {-1, 5.5}, {-1, 4}, {-6, 4}, {-6, -4}};
  for (std::size_t i = 1; i < corners.size(); ++i) append_wall(points, corners[i - 1], corners[i]);
  append_wall(points, {3, -1}, {3.6, -1});
  append_wall(points, {3.6, -1}, {3.6, -1.6});
  return points;
}

std::shared_ptr<const ScorePyramid> pyramid_of(const std::vector<Vector2>& points, int levels = 6) {
  std::vector<TargetPoint> target;
  for (const Vector2& point : points)
    target.push_back({static_cast<float>(point.x()), static_cast<float>(point.y()), 1.0F});
  return std::make_shared<const ScorePyramid>(target, kCellM, kCellM, levels);
}

std::vector<Eigen::Vector2f> seen_from(const std::vector<Vector2>& points,
                                       const Pose2& target_from_source) {
  std::vector<Eigen::Vector2f> seen;
  for (const Vector2& point : points)
    seen.push_back((inverse(target_from_source) * point).cast<float>());
  return seen;
}

void run_to_its_end(WideSearch& search, std::uint64_t piece = 1'000'000) {
  while (!search.is_done()) search.advance(piece);
}

TEST(ScorePyramid, BoundsEveryPoseOfABlockFromAbove) {
  const auto pyramid = pyramid_of(room());
  const auto points = seen_from(room(), {});
  float reach_m = 0.0F;
  for (const auto& point : points) reach_m = std::max(reach_m, point.norm());
  const double step_rad = kCellM / reach_m;
  const auto at_heading = [&](double steps) {
    CellPoints cells;
    for (const Eigen::Vector2f& point : points) {
      const Vector2 at =
          pyramid->in_cells(geometry::rotation(0.7 + steps * step_rad) * point.cast<double>());
      cells.columns.push_back(static_cast<std::int32_t>(std::floor(at.x())));
      cells.rows.push_back(static_cast<std::int32_t>(std::floor(at.y())));
    }
    return cells;
  };
  for (int level = 1; level <= 5; ++level) {
    const std::int32_t side = 1 << level;
    const std::int32_t headings = ScorePyramid::headings_of(level);
    const CellPoints middle = at_heading(0.5 * (headings - 1));
    for (const std::int32_t corner : {-97, -40, -13, 0, 22}) {
      const std::uint32_t bound = pyramid->sum(middle, corner, -corner / 2, level);
      for (std::int32_t heading = 0; heading < headings; ++heading) {
        const CellPoints turned = at_heading(heading);
        for (const std::int32_t column : {0, side / 2, side - 1}) {
          for (const std::int32_t row : {0, side / 3, side - 1})
            ASSERT_LE(pyramid->sum(turned, corner + column, -corner / 2 + row, 0), bound)
                << "level " << level;
        }
      }
    }
  }
}

TEST(WideSearch, FindsAPoseAnywhereInAWideWindow) {
  const Pose2 truth{3.3, -4.7, 2.4};
  WideSearch search(seen_from(room(), truth), kCellM, {});
  search.add_target({pyramid_of(room()), {}, {10.0, 10.0, std::numbers::pi}, {}});
  run_to_its_end(search);
  ASSERT_FALSE(search.peaks().empty());
  EXPECT_THAT(search.peaks().front().target_from_source, PoseNear(truth, 0.1));
}

TEST(WideSearch, FindsTheBestPoseThatComparingAllFinds) {
  const Pose2 truth{0.7, -0.4, 0.2};
  const auto points = seen_from(room(), truth);
  const SearchWindow window{1.0, 1.0, 0.1};
  WideSearch exhaustive(points, kCellM, {.min_score = 0.0});
  // no level but the finest: no bounds
  exhaustive.add_target({pyramid_of(room(), 0), {0.2, 0.1, 0.15}, window, {}});
  WideSearch bounded(points, kCellM, {.min_score = 0.0});
  bounded.add_target({pyramid_of(room()), {0.2, 0.1, 0.15}, window, {}});
  run_to_its_end(exhaustive);
  run_to_its_end(bounded);
  EXPECT_EQ(bounded.peaks().front().target_from_source,
            exhaustive.peaks().front().target_from_source);
  EXPECT_EQ(bounded.peaks().front().score, exhaustive.peaks().front().score);
}

TEST(WideSearch, GivesTheSameAnswerHoweverItIsCut) {
  const auto run_in_pieces_of = [](std::uint64_t piece) {
    WideSearch search(seen_from(room(), {3.0, 2.0, -1.0}), kCellM, {});
    search.add_target({pyramid_of(room()), {}, {8.0, 8.0, std::numbers::pi}, {}});
    run_to_its_end(search, piece);
    return search.peaks();
  };
  const auto whole = run_in_pieces_of(1'000'000'000);
  const auto cut = run_in_pieces_of(1);
  ASSERT_EQ(whole.size(), cut.size());
  for (std::size_t i = 0; i < whole.size(); ++i)
    EXPECT_EQ(whole[i].target_from_source, cut[i].target_from_source);
}

TEST(WideSearch, StopsSoonAfterTheWorkThatItWasGiven) {
  WideSearch search(seen_from(room(), {3.0, 2.0, -1.0}), kCellM, {});
  search.add_target({pyramid_of(room()), {}, {8.0, 8.0, std::numbers::pi}, {}});
  constexpr std::uint64_t kMostOfOneBlock = 200'000;
  EXPECT_LT(search.advance(100'000), 100'000 + kMostOfOneBlock);
  EXPECT_FALSE(search.is_done());
}

TEST(WideSearch, ChoosesAmongSeveralTargetsAndTakesOnePlaceOnce) {
  std::vector<Vector2> corridor;
  append_wall(corridor, {-8, -1}, {8, -1});
  append_wall(corridor, {-8, 1}, {8, 1});
  const Pose2 truth{1.0, 1.0, 0.3};
  WideSearch search(seen_from(room(), truth), kCellM, {.max_peaks = 5});
  const Pose2 shifted_from_room{2.0, 0.0, 0.0};
  std::vector<Vector2> shifted_room;
  for (const Vector2& point : room()) shifted_room.push_back(shifted_from_room * point);
  search.add_target({pyramid_of(corridor), {}, {3.0, 3.0, 0.5}, {50.0, 0.0, 0.0}});
  search.add_target({pyramid_of(room()), {}, {3.0, 3.0, 0.5}, {}});
  search.add_target({pyramid_of(shifted_room), {}, {5.0, 3.0, 0.5}, inverse(shifted_from_room)});
  run_to_its_end(search);
  ASSERT_EQ(search.peaks().size(), 1U);
  EXPECT_NE(search.peaks().front().target, 0U);
}

TEST(WideSearch, FindsNothingThatFitsWorseThanItMay) {
  const Pose2 truth{0.7, -0.4, 0.2};
  auto half_of_it_elsewhere = seen_from(room(), truth);
  for (std::size_t i = half_of_it_elsewhere.size(); i > 0; --i)
    half_of_it_elsewhere.emplace_back(100.0F, 0.2F * static_cast<float>(i));
  const auto peaks_from = [&](double min_score) {
    WideSearch search(half_of_it_elsewhere, kCellM, {.min_score = min_score});
    search.add_target({pyramid_of(room()), {}, {1.0, 1.0, 0.3}, {}});
    run_to_its_end(search);
    return search.peaks();
  };
  const auto found = peaks_from(0.35);
  ASSERT_FALSE(found.empty());
  EXPECT_THAT(found.front().target_from_source, PoseNear(truth, 0.1));
  EXPECT_LT(found.front().score, 0.55);
  EXPECT_TRUE(peaks_from(0.6).empty());
}

TEST(WideSearch, FindsNothingWithoutPointsOrTargets) {
  WideSearch without_points({}, kCellM, {});
  EXPECT_TRUE(without_points.is_done());
  WideSearch without_targets(seen_from(room(), {}), kCellM, {});
  run_to_its_end(without_targets);
  EXPECT_TRUE(without_targets.peaks().empty());
}

}  // namespace
}  // namespace slammot::matching
