#include "services/loop_closing/support.hpp"

#include <gtest/gtest.h>

namespace slammot::loop_closing {
namespace {

using flow::Constraint;
using flow::ConstraintKind;
using geometry::Pose2;

constexpr double kStep_m = 20.0;

/// Two drives along one street, submaps 0 to 4 and 5 to 9, that nothing ties together.
class Support : public ::testing::Test {
 protected:
  Support() {
    for (std::uint32_t id = 0; id < 10; ++id) {
      const double way_m = kStep_m * id + (id < 5 ? 0.0 : 1000.0);
      Place& place = places_[{id}];
      place.id = {id};
      place.travelled_before_m = way_m;
      place.travelled_after_m = way_m + kStep_m;
      place.cell_size_m = 0.2;
      graph_.add_node({id}, {kStep_m * (id % 5), id < 5 ? 0.0 : 500.0, 0.0});
      if (id % 5 == 0) continue;
      graph_.add_constraint({{id - 1},
                             {id},
                             ConstraintKind::kOdometric,
                             {{kStep_m, 0.0, 0.0}, 0.01 * geometry::Matrix3::Identity()}});
    }
  }

  SubmapView submaps() const { return {config_, places_, graph_}; }

  static Hypothesis hypothesis(std::uint32_t from, std::uint32_t to, double x_m) {
    return {.from = {from},
            .to = {to},
            .from_to = {{x_m, 0.0, 0.0}, 0.0025 * geometry::Matrix3::Identity()},
            .agreement = {.occupied_in_both = 100, .source_in_target = 100, .source_walls = 100}};
  }

  LoopClosingConfig config_;
  Places places_;
  ClosureGraph graph_{{}};
};

TEST_F(Support, CountsSubmapsThatImplyTheSameRelativePose) {
  const std::vector<Hypothesis> all{hypothesis(0, 5, 3.0), hypothesis(1, 6, 3.1),
                                    hypothesis(2, 7, 2.9), hypothesis(2, 8, 60.0)};
  EXPECT_EQ(support_of(submaps(), all, all.front()), 3);
  EXPECT_EQ(support_of(submaps(), all, all.back()), 1);
}

TEST_F(Support, CountsASubmapOnce) {
  const std::vector<Hypothesis> all{hypothesis(0, 5, 3.0), hypothesis(1, 6, 3.0),
                                    hypothesis(2, 6, -17.0)};
  EXPECT_EQ(support_of(submaps(), all, all.front()), 2);
  EXPECT_EQ(consistent_set(submaps(), all, all.front()).size(), 2U);
}

TEST_F(Support, LeavesOutOfTheConsistentSetWhatContradictsItsMembers) {
  // Each is within the drift since the first one, 40 and 60 m before; between both are only 20 m.
  const std::vector<Hypothesis> all{hypothesis(0, 5, 0.0), hypothesis(2, 7, 1.5),
                                    hypothesis(3, 8, -1.5)};
  ASSERT_TRUE(agree(submaps(), all[0], all[1]));
  ASSERT_TRUE(agree(submaps(), all[0], all[2]));
  ASSERT_FALSE(agree(submaps(), all[1], all[2]));
  EXPECT_EQ(support_of(submaps(), all, all.front()), 3);
  EXPECT_EQ(consistent_set(submaps(), all, all.front()).size(), 2U);
}

TEST_F(Support, DropsWhatIsContradictedWhereAnotherTargetFitsElsewhere) {
  std::vector<Hypothesis> all{hypothesis(0, 4, 80.0), hypothesis(1, 4, 72.0),
                              hypothesis(1, 3, 28.0)};
  all[1].agreement.contradicted = 8;
  all[2].agreement.contradicted = 8;
  select_on_one_island(submaps(), 0.75, {4}, all);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].from.value, 0U);
  EXPECT_FALSE(all[0].has_rivals);
  EXPECT_EQ(all[1].to.value, 3U) << "another submap's";
}

TEST_F(Support, IsAmbiguousWhereTargetsPutASubmapAtTwoPlaces) {
  std::vector<Hypothesis> apart{hypothesis(0, 4, 80.0), hypothesis(1, 4, 72.0)};
  select_on_one_island(submaps(), 0.75, {4}, apart);
  ASSERT_EQ(apart.size(), 2U);
  EXPECT_TRUE(apart[0].has_rivals);
  EXPECT_TRUE(apart[1].has_rivals);
  std::vector<Hypothesis> same{hypothesis(0, 4, 80.0), hypothesis(1, 4, 60.2)};
  select_on_one_island(submaps(), 0.75, {4}, same);
  ASSERT_EQ(same.size(), 2U);
  EXPECT_FALSE(same[0].has_rivals);
  EXPECT_FALSE(same[1].has_rivals);
}

TEST_F(Support, CountsOneOfSeveralPosesOfASubmapByItsShare) {
  // Submap 4 lies at any of four poses along a bare corridor; one of them agrees with submap 3.
  std::vector<Hypothesis> all{hypothesis(0, 3, 60.0), hypothesis(1, 4, 60.0),
                              hypothesis(1, 4, 57.0), hypothesis(1, 4, 54.0),
                              hypothesis(1, 4, 51.0)};
  EXPECT_EQ(support_of(submaps(), all, all.front()), 2.0);
  select_on_one_island(submaps(), 0.75, {4}, all);
  ASSERT_EQ(all.size(), 5U);
  EXPECT_EQ(support_of(submaps(), all, all.front()), 1.25);
}

TEST_F(Support, DoesNotLetHypothesesOnAnotherIslandCompete) {
  std::vector<Hypothesis> all{hypothesis(0, 4, 80.0), hypothesis(5, 4, 72.0)};
  all[1].agreement.contradicted = 8;
  select_on_one_island(submaps(), 0.75, {4}, all);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_FALSE(all[0].has_rivals);
}

TEST_F(Support, HoldsAClosureAgainstTheUncertaintyOfTheGraph) {
  const Constraint near{{0}, {2}, ConstraintKind::kLoop, hypothesis(0, 2, 40.3).from_to};
  const Constraint far{{0}, {2}, ConstraintKind::kLoop, hypothesis(0, 2, 46.0).from_to};
  EXPECT_LT(error_with_graph_uncertainty(graph_, near), kMaxSquaredError);
  EXPECT_GT(error_with_graph_uncertainty(graph_, far), kMaxSquaredError);
}

}  // namespace
}  // namespace slammot::loop_closing
