#include "services/loop_closing/search_queue.hpp"

#include <deque>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/floor_plan.hpp"

namespace slammot::loop_closing {
namespace {

using geometry::Pose2;
using slammot::testing::FloorPlan;
using Extent = SearchQueue::Extent;

RevisitConfig indoor_config() {
  RevisitConfig config;
  config.registration = {.fine_gate_m = 0.2, .surfel_sigma_m = 0.04};
  return config;
}

/// Hall of 30 x 12 m with two different pillars.
FloorPlan hall() {
  FloorPlan plan;
  plan.add_box({-15, -6}, {15, 6});
  plan.add_box({2, 1}, {3, 2.5});
  plan.add_box({-6, -3}, {-4, -2.5});
  return plan;
}

class SearchQueueTest : public ::testing::Test {
 protected:
  SearchQueueTest() { place(0, {}); }

  const Place& place(std::uint32_t id, const Pose2& map_from_base) {
    slammot::testing::SubmapMaker maker;
    maker.reach_m = 12.0;
    places_.push_back(make_place(
        submap_seen_from(hall(), id, {map_from_base, map_from_base * Pose2{0.5, 0.0, 0.0}}, maker),
        0.0, {.tolerance_m = 0.15}));
    return places_.back();
  }

  /// For a place seen 2 m from its expected pose, on the first target.
  RevisitSearch search(std::uint32_t id, double sigma_m) {
    const Pose2 truth{2.0, 0.5, 0.1};
    const Place& source = place(id, truth);
    const geometry::UncertainPose2 expected{
        {}, Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, 0.04).asDiagonal()};
    return {indoor_config(), source, {{{{{&places_.front(), {}}}}, expected, {}}}};
  }

  /// For a thicket on all of many other thickets, over all headings: everything fits a little.
  RevisitSearch hopeless_search(std::uint32_t id) {
    const Place& source = thicket(id);
    const geometry::UncertainPose2 anywhere{
        {}, Eigen::Vector3d(400.0, 400.0, std::numbers::pi * std::numbers::pi).asDiagonal()};
    constexpr std::uint32_t kTargets = 10;
    std::vector<RevisitCandidate> candidates;
    for (std::uint32_t i = 0; i < kTargets; ++i)
      candidates.push_back({{{{&thicket(1000 + i), {}}}}, anywhere, {100.0 * i, 0.0, 0.0}});
    return {indoor_config(), source, std::move(candidates)};
  }

  const Place& thicket(std::uint32_t id) {
    std::mt19937_64 random(id);
    std::uniform_real_distribution<double> place_m(-11.0, 11.0);
    std::uniform_real_distribution<double> part_m(-0.3, 0.3);
    FloorPlan plan;
    for (int trunk = 0; trunk < 150; ++trunk) {
      const geometry::Vector2 at_m(place_m(random), place_m(random));
      plan.add(at_m, at_m + geometry::Vector2(part_m(random), part_m(random)));
    }
    places_.push_back(
        make_place(submap_seen_from(plan, id, {{}, {4.0, 3.0, 0.0}, {-5.0, 2.0, 0.0}}), 0.0,
                   {.tolerance_m = 0.15}));
    return places_.back();
  }

  std::deque<Place> places_;  ///< Searches refer to them.
};

std::vector<std::uint32_t> sources_of(const std::vector<SearchQueue::Finished>& finished) {
  std::vector<std::uint32_t> sources;
  for (const auto& one : finished) sources.push_back(one.source.value);
  return sources;
}

TEST_F(SearchQueueTest, ReturnsTheHypothesesOfAFinishedSearch) {
  SearchQueue queue{SearchBudget{}};
  queue.add(search(1, 1.5), Extent::kExpected);
  EXPECT_FALSE(queue.is_empty());
  std::vector<SearchQueue::Finished> finished;
  for (int submaps = 0; submaps < 20 && finished.empty(); ++submaps) finished = queue.advance();
  ASSERT_EQ(finished.size(), 1U);
  EXPECT_EQ(finished.front().source, flow::SubmapId{1});
  EXPECT_EQ(finished.front().target, flow::SubmapId{0});
  EXPECT_FALSE(finished.front().is_given_up);
  EXPECT_FALSE(finished.front().hypotheses.empty());
  EXPECT_TRUE(queue.is_empty());
  EXPECT_GT(queue.work(), 0U);
  EXPECT_EQ(queue.given_up(), 0U);
}

TEST_F(SearchQueueTest, SearchesExpectedPlacesBeforeEverywhere) {
  SearchQueue queue{SearchBudget{}};
  queue.add(search(1, 1.5), Extent::kEverywhere);
  queue.add(search(2, 1.5), Extent::kExpected);
  queue.add(search(3, 1.5), Extent::kExpected);
  std::vector<std::uint32_t> order;
  for (int submaps = 0; submaps < 40 && order.size() < 3; ++submaps)
    for (const std::uint32_t source : sources_of(queue.advance())) order.push_back(source);
  EXPECT_EQ(order, (std::vector<std::uint32_t>{2, 3, 1}));
}

/// Work of a search until the condition no longer holds, without building targets.
template <typename Condition>
std::uint64_t work_while(RevisitSearch& search, PyramidCache& pyramids, const Condition& holds) {
  const std::uint64_t before = search.work();
  while (holds(search)) search.advance(1, pyramids);
  return search.work() - before;
}

TEST_F(SearchQueueTest, SearchesNearEachExpectedPoseBeforeAnyFullWindow) {
  const auto is_near_expected = [](const RevisitSearch& one) { return one.is_near_expected(); };
  PyramidCache pyramids;
  RevisitSearch around = search(1, 4.0);
  work_while(around, pyramids, is_near_expected);
  ASSERT_FALSE(around.is_done());
  const RevisitSearch near = search(2, 4.0);
  ASSERT_TRUE(near.is_near_expected());
  RevisitSearch around_alone = around;
  RevisitSearch near_alone = near;
  const std::uint64_t work_around =
      work_while(around_alone, pyramids, [](const RevisitSearch& one) { return !one.is_done(); });
  const std::uint64_t work_near = work_while(near_alone, pyramids, is_near_expected);

  SearchQueue queue{{.work_per_submap = 1.0, .work_per_search = 1e12}};
  queue.add(around, Extent::kExpected);
  queue.add(near, Extent::kExpected);
  std::vector<std::uint32_t> finished;
  for (int submaps = 0; submaps < 100'000 && finished.empty(); ++submaps)
    finished = sources_of(queue.advance());
  EXPECT_EQ(finished, (std::vector<std::uint32_t>{1}));
  EXPECT_GE(queue.work(), work_near + work_around);
}

TEST_F(SearchQueueTest, GivesUpASearchThatHasReadTooMuch) {
  SearchQueue queue{{.work_per_submap = 60e6, .work_per_search = 1e4}};
  queue.add(search(1, 4.0), Extent::kExpected);
  const auto finished = queue.advance();
  ASSERT_EQ(finished.size(), 1U);
  EXPECT_TRUE(finished.front().is_given_up);
  EXPECT_EQ(queue.given_up(), 1U);
}

TEST_F(SearchQueueTest, SpreadsAHopelessSearchOverThreeSubmapsBeforeItIsGivenUp) {
  SearchQueue queue{SearchBudget{}};
  queue.add(hopeless_search(1), Extent::kEverywhere);
  int submaps = 0;
  while (!queue.is_empty() && submaps < 10) {
    queue.advance();
    ++submaps;
  }
  EXPECT_EQ(submaps, 3);
  EXPECT_EQ(queue.given_up(), 1U);
}

TEST_F(SearchQueueTest, EndsADriveWithNoMoreWorkThanForTwoSubmaps) {
  SearchQueue queue{SearchBudget{}};
  for (const std::uint32_t id : {1U, 2U}) queue.add(hopeless_search(id), Extent::kEverywhere);
  queue.advance();
  const std::uint64_t work_of_submap = queue.work();
  queue.finish();
  EXPECT_LE(queue.work() - work_of_submap, 2 * work_of_submap);
  EXPECT_TRUE(queue.is_empty());
}

TEST_F(SearchQueueTest, GivesUpTheOldestSearchEverywhereWhenTooManyArePending) {
  SearchQueue queue{{.work_per_submap = 0.0, .most_waiting = 2}};
  queue.add(search(1, 1.5), Extent::kExpected);
  queue.add(search(2, 1.5), Extent::kEverywhere);
  queue.add(search(3, 1.5), Extent::kEverywhere);
  const auto finished = queue.advance();
  EXPECT_EQ(sources_of(finished), (std::vector<std::uint32_t>{2}));
  EXPECT_TRUE(finished.front().is_given_up);
  EXPECT_TRUE(queue.advance().empty()) << "told once";
}

TEST_F(SearchQueueTest, GivesUpPendingSearchesAtTheEnd) {
  SearchQueue queue{{.work_per_submap = 0.0, .work_at_end = 1.0}};
  queue.add(search(1, 4.0), Extent::kExpected);
  queue.add(search(2, 4.0), Extent::kEverywhere);
  const auto finished = queue.finish();
  EXPECT_EQ(finished.size(), 2U);
  EXPECT_TRUE(queue.is_empty());
  EXPECT_EQ(queue.given_up(), 2U);
}

TEST_F(SearchQueueTest, SpendsTheFinalBudgetOnPendingSearches) {
  SearchQueue queue{{.work_per_submap = 0.0}};
  queue.add(search(1, 1.5), Extent::kExpected);
  EXPECT_TRUE(queue.advance().empty());
  const auto finished = queue.finish();
  ASSERT_EQ(finished.size(), 1U);
  EXPECT_FALSE(finished.front().is_given_up);
  EXPECT_FALSE(finished.front().hypotheses.empty());
}

}  // namespace
}  // namespace slammot::loop_closing
