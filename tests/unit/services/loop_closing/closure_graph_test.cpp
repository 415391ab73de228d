#include "services/loop_closing/closure_graph.hpp"

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"

namespace slammot::loop_closing {
namespace {

using flow::ClosureState;
using flow::Constraint;
using flow::ConstraintKind;
using flow::SubmapId;
using geometry::Pose2;
using testing::PoseNear;

constexpr double kStep_m = 10.0;

geometry::UncertainPose2 measured(const Pose2& pose, double sigma) {
  return {pose, geometry::Matrix3::Identity() * sigma * sigma};
}

Constraint odometric(std::uint32_t from, double sigma = 0.1) {
  return {{from}, {from + 1}, ConstraintKind::kOdometric, measured({kStep_m, 0.0, 0.0}, sigma)};
}

Constraint closure(std::uint32_t from, std::uint32_t to, double x_m) {
  return {{from}, {to}, ConstraintKind::kLoop, measured({x_m, 0.0, 0.0}, 0.05)};
}

/// Submaps on a line, `kStep_m` apart, as odometry measures them.
ClosureGraph line(std::uint32_t submaps) {
  ClosureGraph graph({});
  for (std::uint32_t id = 0; id < submaps; ++id) {
    graph.add_node({id}, {kStep_m * id, 0.0, 0.0});
    if (id > 0) graph.add_constraint(odometric(id - 1));
  }
  return graph;
}

bool never(const Constraint&) { return false; }
bool always(const Constraint&) { return true; }

void add(ClosureGraph& graph, const Constraint& closure, const ClosureGraph::Agrees& agrees) {
  const auto before = graph.snapshot();
  graph.propose(closure);
  graph.solve_since(before, agrees);
  graph.update_verdicts("outweighed");
}

ClosureState state_of(const ClosureGraph& graph, const Constraint& closure) {
  for (const Constraint& one : graph.constraints()) {
    if (one.from == closure.from && one.to == closure.to && one.kind == closure.kind)
      return one.verdict.state;
  }
  ADD_FAILURE() << "no such closure";
  return ClosureState::kRejected;
}

TEST(ClosureGraph, JoinsIslandsByMovingTheLaterOne) {
  ClosureGraph graph = line(2);
  graph.add_node({2}, {500.0, 3.0, 1.0});
  graph.add_node({3}, {510.0, 3.0, 1.0});
  graph.add_constraint(odometric(2));
  EXPECT_FALSE(graph.are_on_one_island({0}, {3}));
  const Pose2 two_from_three =
      geometry::inverse(graph.map_from_node({2})) * graph.map_from_node({3});
  const Constraint found = closure(1, 2, 4.0);
  graph.join_islands(found);
  graph.propose(found);
  EXPECT_EQ(graph.island_of({3}), SubmapId{0});
  EXPECT_THAT(graph.map_from_node({2}), PoseNear(Pose2{14.0, 0.0, 0.0}, 1e-9));
  EXPECT_THAT(geometry::inverse(graph.map_from_node({2})) * graph.map_from_node({3}),
              PoseNear(two_from_three, 1e-9));
}

TEST(ClosureGraph, GivesTheUncertaintyAlongThePathWithScaledOdometry) {
  const ClosureGraph graph = line(4);
  const auto expected = graph.expectations_from({0});
  EXPECT_THAT(expected.at({3}).pose, PoseNear(Pose2{30.0, 0.0, 0.0}, 1e-9));
  EXPECT_NEAR(expected.at({1}).covariance(0, 0), 4.0 * 0.01, 1e-9);
  // A heading sigma of 0.2 rad a step bends the path: 0.644 by Monte Carlo, 0.12 to first order.
  EXPECT_NEAR(expected.at({3}).covariance(0, 0), 0.644, 0.16);
}

TEST(ClosureGraph, AcceptsAClosureWithinItsUncertainty) {
  ClosureGraph graph = line(5);
  const Constraint found = closure(0, 4, 40.1);
  const auto before = graph.snapshot();
  graph.propose(found);
  graph.solve_since(before, never);
  EXPECT_TRUE(graph.is_newest_active());
  graph.update_verdicts("");
  EXPECT_EQ(state_of(graph, found), ClosureState::kAccepted);
  EXPECT_NEAR(graph.map_from_node({4}).x_m, 40.1, 0.05);
}

TEST(ClosureGraph, ExcludesAClosureThatDistortsTheGraph) {
  ClosureGraph graph = line(5);
  const Constraint found = closure(0, 4, 48.0);
  const auto before = graph.snapshot();
  graph.propose(found);
  graph.solve_since(before, never);
  EXPECT_FALSE(graph.is_newest_active());
  graph.update_verdicts("");
  EXPECT_EQ(state_of(graph, found), ClosureState::kRejected);
  EXPECT_NEAR(graph.map_from_node({4}).x_m, 40.0, 1e-6);
}

/// On a line of eight submaps that two closures tie, with false ones that were excluded.
ClosureGraph line_with_excluded_closures() {
  ClosureGraph graph = line(8);
  for (const Constraint& one : {closure(0, 5, 50.0), closure(1, 6, 50.0), closure(0, 6, 66.0),
                                closure(0, 7, 76.0), closure(1, 7, 66.0)})
    add(graph, one, never);
  return graph;
}

TEST(ClosureGraph, AcceptsAClosureThatItPredictsThoughItAgreesWithExcludedOnes) {
  ClosureGraph graph = line_with_excluded_closures();
  const auto solves = graph.counters().optimisations;
  add(graph, closure(2, 7, 50.0), always);
  EXPECT_EQ(state_of(graph, closure(2, 7, 50.0)), ClosureState::kAccepted);
  for (const Constraint& one : {closure(0, 6, 66.0), closure(0, 7, 76.0), closure(1, 7, 66.0)})
    EXPECT_EQ(state_of(graph, one), ClosureState::kRejected);
  EXPECT_EQ(graph.counters().optimisations, solves + 1) << "there is nothing to weigh";
}

TEST(ClosureGraph, SolvesOnceForEachClosureThatItPredictsHoweverOftenAPlaceIsSeen) {
  ClosureGraph graph = line_with_excluded_closures();
  const auto solves = graph.counters().optimisations;
  constexpr std::uint32_t kPasses = 30;
  for (std::uint32_t id = 8; id < 8 + kPasses; ++id) {
    graph.add_node({id}, {7.0 * kStep_m, 0.0, 0.0});
    graph.add_constraint(
        {{id - 1}, {id}, ConstraintKind::kOdometric, measured(Pose2::identity(), 0.1)});
    add(graph, closure(0, id, 70.0), always);
  }
  EXPECT_EQ(graph.counters().optimisations, solves + kPasses);
}

TEST(ClosureGraph, TakesAnExcludedClosureBackOnceItFits) {
  ClosureGraph graph = line(8);
  add(graph, closure(0, 3, 32.0), never);
  ASSERT_EQ(state_of(graph, closure(0, 3, 32.0)), ClosureState::kRejected);
  // All submaps from 3 on are two metres further.
  for (const std::uint32_t from : {0U, 1U, 2U})
    add(graph, closure(from, 7, 72.0 - kStep_m * from), always);
  EXPECT_EQ(state_of(graph, closure(2, 7, 52.0)), ClosureState::kAccepted);
}

TEST(ClosureGraph, RestoresItsStateBeforeAClosure) {
  ClosureGraph graph = line(5);
  const auto before = graph.snapshot();
  graph.propose(closure(0, 4, 40.1));
  graph.solve_since(before, never);
  graph.restore(before);
  EXPECT_EQ(graph.constraints().size(), 4U);
  EXPECT_NEAR(graph.map_from_node({4}).x_m, 40.0, 1e-9);
}

TEST(ClosureGraph, WithdrawsAGroupAfterRepeatedContradictions) {
  ClosureGraph graph = line(5);
  const Constraint found = closure(0, 4, 40.1);
  EXPECT_TRUE(graph.founds_group(found));
  graph.propose(found);
  graph.solve("");
  EXPECT_FALSE(graph.founds_group(closure(1, 4, 30.0)));
  graph.contradict_path({4}, {0});
  EXPECT_EQ(state_of(graph, found), ClosureState::kAccepted);
  graph.contradict_path({4}, {0});
  EXPECT_EQ(state_of(graph, found), ClosureState::kWithdrawn);
  EXPECT_EQ(graph.counters().withdrawn, 1U);
  EXPECT_NEAR(graph.map_from_node({4}).x_m, 40.0, 1e-6);
}

TEST(ClosureGraph, KeepsAConfirmedGroupAgainstAFewContradictions) {
  ClosureGraph graph = line(5);
  const Constraint found = closure(0, 4, 40.1);
  graph.propose(found);
  graph.solve("");
  graph.confirm_path({0}, {4});
  for (int i = 0; i < 2; ++i) graph.contradict_path({4}, {0});
  EXPECT_EQ(state_of(graph, found), ClosureState::kAccepted);
  graph.contradict_path({4}, {0});
  EXPECT_EQ(state_of(graph, found), ClosureState::kWithdrawn);
}

}  // namespace
}  // namespace slammot::loop_closing
