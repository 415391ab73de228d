#include "services/loop_closing/loop_closer.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"
#include "tests/support/ring_drive.hpp"

namespace slammot::loop_closing {
namespace {

using flow::GraphCorrection;
using flow::Submap;
using flow::SubmapId;
using geometry::Pose2;
using slammot::testing::drive;
using slammot::testing::FloorPlan;
using slammot::testing::indoor_loop_closing;
using slammot::testing::PoseNear;
using slammot::testing::ring;
using slammot::testing::way_around_the_ring;

double largest_error_m(const GraphCorrection& correction, const std::vector<Pose2>& map_from_base) {
  double largest_m = 0.0;
  for (const auto& node : correction.submaps) {
    const Pose2 truth = inverse(map_from_base.front()) * map_from_base[12 * node.submap_id.value];
    largest_m =
        std::max(largest_m, (node.map_from_submap.translation_m() - truth.translation_m()).norm());
  }
  return largest_m;
}

TEST(LoopCloser, ClosesALoopWithDriftingOdometry) {
  const auto way = way_around_the_ring(1.3);
  const auto submaps = drive(ring(), way, 0.002);
  LoopCloser closer(indoor_loop_closing());
  GraphCorrection correction;
  for (const Submap& submap : submaps) correction = closer.add(submap);
  GraphCorrection uncorrected;
  for (const Submap& submap : submaps)
    uncorrected.submaps.push_back({submap.submap_id, submap.odom_from_submap});
  EXPECT_GT(largest_error_m(uncorrected, way), 1.5);
  EXPECT_GE(closer.counters().closures, 2U);
  EXPECT_LT(largest_error_m(correction, way), 0.3);
}

TEST(LoopCloser, ClosesTheSameLoopsWithTheKalmanFilter) {
  const auto way = way_around_the_ring(1.3);
  LoopClosingConfig config = indoor_loop_closing();
  LoopCloser by_graph(config);
  config.graph.estimator = graphs::Estimator::kEkf;
  LoopCloser by_filter(config);
  GraphCorrection graph;
  GraphCorrection filter;
  for (const Submap& submap : drive(ring(), way, 0.002)) {
    graph = by_graph.add(submap);
    filter = by_filter.add(submap);
  }
  EXPECT_EQ(by_filter.counters().closures, by_graph.counters().closures);
  EXPECT_LT(largest_error_m(filter, way), 1.1 * largest_error_m(graph, way) + 0.01);
}

TEST(LoopCloser, ClosesTheSameLoopsThoughGnssJumpsByAKilometre) {
  const auto way = way_around_the_ring(1.3);
  LoopCloser without_gnss(indoor_loop_closing());
  LoopCloser closer(indoor_loop_closing());
  const std::vector<Submap> submaps = drive(ring(), way, 0.002);
  for (std::size_t i = 0; i < submaps.size(); ++i) {
    without_gnss.add(submaps[i]);
    Submap submap = submaps[i];
    const double jump_deg = 2 * i < submaps.size() ? 0.0 : 0.01;
    for (int fix = 0; fix < 5; ++fix)
      submap.fixes.push_back({0.0F, 0.0F, {40.0 + jump_deg, -80.0}, 1.0F, 1.0F, 0.0F});
    closer.add(submap);
  }
  EXPECT_EQ(closer.counters().closures, without_gnss.counters().closures);
}

TEST(LoopCloser, ReturnsThePosesOfAllSubmapsAfterEachOne) {
  const auto submaps = drive(ring(), way_around_the_ring(0.4), 0.0);
  LoopCloser closer(indoor_loop_closing());
  for (std::size_t i = 0; i < submaps.size(); ++i) {
    const GraphCorrection correction = closer.add(submaps[i]);
    EXPECT_EQ(correction.sequence, i + 1);
    ASSERT_EQ(correction.submaps.size(), i + 1);
    EXPECT_THAT(correction.submaps.front().map_from_submap,
                PoseNear(submaps.front().odom_from_submap, 1e-12));
    EXPECT_THAT(correction.map_from_odom * submaps[i].odom_from_submap,
                PoseNear(correction.submaps.back().map_from_submap, 1e-9));
  }
}

TEST(LoopCloser, KeepsAFewPlacesWhereTheVehicleDrivesTheSameWayAgainAndAgain) {
  const auto way = way_around_the_ring(20.0);
  const auto submaps = drive(ring(), way, 0.0005);
  LoopCloser closer(indoor_loop_closing());
  std::vector<std::size_t> kept;
  std::vector<std::uint64_t> closures;
  for (const Submap& submap : submaps) {
    closer.add(submap);
    kept.push_back(0);
    for (const auto& [id, place] : closer.submaps().places)
      kept.back() += place.is_superseded ? 0 : 1;
    closures.push_back(closer.counters().closures);
  }
  const std::size_t then = submaps.size() * 2 / 3;
  EXPECT_LE(kept.back(), kept[then] + 2) << "of " << submaps.size();
  EXPECT_LT(kept.back(), submaps.size() * 3 / 4);
  EXPECT_GT(closures.back(), closures[then] + submaps.size() / 6)
      << "they suffice to find it again";
  EXPECT_LT(largest_error_m(closer.finish(), way), 0.3);
}

TEST(LoopCloser, IgnoresARepeatedSubmap) {
  const auto submaps = drive(ring(), way_around_the_ring(0.4), 0.0);
  LoopCloser closer(indoor_loop_closing());
  for (const Submap& submap : submaps) closer.add(submap);
  const std::size_t constraints = closer.constraints().size();
  EXPECT_EQ(closer.add(submaps[1]).submaps.size(), submaps.size());
  EXPECT_EQ(closer.constraints().size(), constraints);
  EXPECT_EQ(closer.counters().repeated_submaps, 1U);
}

TEST(LoopCloser, BridgesAMissingSubmap) {
  const auto submaps = drive(ring(), way_around_the_ring(0.5), 0.0);
  LoopCloser closer(indoor_loop_closing());
  GraphCorrection correction;
  for (const Submap& submap : submaps) {
    if (submap.submap_id != SubmapId{2}) correction = closer.add(submap);
  }
  ASSERT_EQ(correction.submaps.size(), submaps.size() - 1);
  EXPECT_THAT(correction.submaps.back().map_from_submap,
              PoseNear(submaps.back().odom_from_submap, 1e-6));
}

TEST(LoopCloser, GivesTheSameBitsTwice) {
  const auto submaps = drive(ring(), way_around_the_ring(1.2), 0.002);
  LoopCloser first(indoor_loop_closing());
  LoopCloser second(indoor_loop_closing());
  for (const Submap& submap : submaps) {
    const GraphCorrection a = first.add(submap);
    const GraphCorrection b = second.add(submap);
    ASSERT_FALSE(a.submaps.empty());
    ASSERT_EQ(a.submaps.size(), b.submaps.size());
    for (std::size_t i = 0; i < a.submaps.size(); ++i)
      ASSERT_EQ(a.submaps[i].map_from_submap, b.submaps[i].map_from_submap);
  }
  EXPECT_GT(first.counters().closures, 0U);
}

TEST(LoopCloser, SolvesDeferredClosuresAtTheEndOfALongDrive) {
  const auto submaps = drive(ring(), way_around_the_ring(9.0), 0.0);
  ASSERT_GT(submaps.size(), 110U) << "of fewer each closure is solved at once";
  LoopCloser closer(indoor_loop_closing());
  for (const Submap& submap : submaps) closer.add(submap);
  const auto solved = closer.counters().optimisations;
  EXPECT_LT(solved, closer.counters().closures);
  EXPECT_TRUE(closer.has_unfinished_work());
  closer.finish();
  EXPECT_GT(closer.counters().optimisations, solved);
  EXPECT_FALSE(closer.has_unfinished_work());
}

TEST(LoopCloser, SolvesALargeGraphRarelyWhereItPredictsTheClosures) {
  const auto submaps = drive(ring(), way_around_the_ring(16.0), 0.0);
  LoopCloser closer(indoor_loop_closing());
  LoopClosingCounters at_large;
  for (const Submap& submap : submaps) {
    closer.add(submap);
    if (closer.counters().submaps == 110) at_large = closer.counters();
  }
  const auto closures = closer.counters().closures - at_large.closures;
  EXPECT_GT(closures, 100U);
  EXPECT_LT(20 * (closer.counters().optimisations - at_large.optimisations), closures);
}

TEST(LoopCloser, DoesNotConfuseEqualCorridors) {
  // Equal doors at equal distances, and odometry with an error of metres within its covariance.
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
  LoopClosingConfig config = indoor_loop_closing();
  config.max_distance_m = 40.0;
  LoopCloser closer(config);
  for (const Submap& submap : drive(plan, way, 0.0, 4.0)) closer.add(submap);
  EXPECT_GT(closer.counters().searches, 10U);
  EXPECT_EQ(closer.counters().closures, 0U);
}

/// The drive around the ring; the first two submaps of the second round show what lies 12 m ahead
/// of them.
std::vector<Submap> drive_deceived_once(const std::vector<Pose2>& way) {
  std::vector<Submap> submaps = drive(ring(), way, 0.0, 1.6);
  for (const std::size_t deceived : {14U, 15U}) {
    const Submap& other = submaps[deceived - 12];
    submaps[deceived].so_log_odds = other.so_log_odds;
    submaps[deceived].surfels = other.surfels;
  }
  return submaps;
}

TEST(LoopCloser, KeepsNoFalseClosureSupportedByTwoSubmaps) {
  const auto way = way_around_the_ring(1.9);
  LoopClosingConfig credulous = indoor_loop_closing();
  credulous.needed_support = credulous.needed_when_ambiguous = 1;
  credulous.max_distance_m = 2.0;
  LoopCloser closer(credulous);
  GraphCorrection correction;
  for (const Submap& submap : drive_deceived_once(way)) correction = closer.add(submap);
  EXPECT_GT(closer.counters().closures, 5U);
  EXPECT_LT(largest_error_m(correction, way), 0.5);
  for (const flow::Constraint& constraint : closer.constraints()) {
    const bool is_false = constraint.kind == flow::ConstraintKind::kLoop &&
                          constraint.to.value >= 14 && constraint.to.value <= 15;
    if (is_false)
      EXPECT_NE(constraint.verdict.state, flow::ClosureState::kAccepted)
          << constraint.verdict.reason;
    EXPECT_TRUE(constraint.kind == flow::ConstraintKind::kOdometric ||
                !constraint.verdict.reason.empty());
  }
}

TEST(LoopCloser, ReadsNoMoreCellsForASubmapThanItsBudget) {
  const auto submaps = drive(ring(), way_around_the_ring(1.3), 0.002, 6.0);
  LoopClosingConfig config = indoor_loop_closing();
  config.search.work_per_submap = 1e6;
  LoopCloser closer(config);
  constexpr std::uint64_t kMostOfOneStep = 3'000'000;  // Building one target or registering one
                                                       // pose.
  std::uint64_t before = 0;
  for (const Submap& submap : submaps) {
    closer.add(submap);
    EXPECT_LT(closer.counters().search_work - before, 1'000'000 + kMostOfOneStep);
    before = closer.counters().search_work;
  }
  EXPECT_GT(closer.counters().searches_given_up + closer.counters().closures, 0U);
}

/// Two drives of one vehicle that was carried in between: odometry does not observe the motion.
std::vector<Submap> carried_between(std::vector<Submap> before, const std::vector<Submap>& after) {
  for (Submap submap : after) {
    submap.submap_id = {static_cast<std::uint32_t>(before.size())};
    submap.odom_from_submap = Pose2{300.0, -200.0, 2.5} * submap.odom_from_submap;
    if (submap.previous_from_submap.covariance.isZero()) {  // first submap of a drive
      submap.previous_from_submap.pose =
          inverse(before.back().odom_from_submap) * submap.odom_from_submap;
      submap.previous_from_submap.covariance = Eigen::Vector3d(225.0, 225.0, 10.0).asDiagonal();
    }
    before.push_back(submap);
  }
  return before;
}

class CarriedAway : public ::testing::Test {
 protected:
  CarriedAway() : around_(way_around_the_ring(1.08)), before_(drive(ring(), around_, 0.0)) {
    const auto again = way_around_the_ring(1.0);
    after_.assign(again.begin() + 60, again.begin() + 121);  // from the next corridor on, five
                                                             // submaps
  }

  /// Of the submaps after the vehicle was carried, in map.
  double largest_error_after_m(const GraphCorrection& correction) const {
    double largest_m = 0.0;
    for (std::size_t i = before_.size(); i < correction.submaps.size(); ++i) {
      const Pose2 truth = inverse(around_.front()) * after_[12 * (i - before_.size())];
      largest_m = std::max(
          largest_m,
          (correction.submaps[i].map_from_submap.translation_m() - truth.translation_m()).norm());
    }
    return largest_m;
  }

  std::vector<Pose2> around_;
  std::vector<Pose2> after_;
  std::vector<Submap> before_;
  LoopCloser closer_{indoor_loop_closing()};
};

TEST_F(CarriedAway, IsLocatedAtAnyDistance) {
  GraphCorrection correction;
  for (const Submap& submap : carried_between(before_, drive(ring(), after_, 0.0)))
    correction = closer_.add(submap);
  EXPECT_TRUE(closer_.is_connected());
  EXPECT_EQ(closer_.counters().found_elsewhere, 1U);
  EXPECT_LT(largest_error_after_m(correction), 0.2);
}

TEST_F(CarriedAway, IsUnconnectedUntilTwoSubmapsAgree) {
  const auto submaps = carried_between(before_, drive(ring(), after_, 0.0));
  for (const Submap& submap : before_) closer_.add(submap);
  EXPECT_TRUE(closer_.is_connected());
  EXPECT_TRUE(closer_.add(submaps[before_.size()]).is_untied);
  EXPECT_FALSE(closer_.is_connected());
}

TEST_F(CarriedAway, StaysUnconnectedInAnUnknownPlace) {
  FloorPlan elsewhere;  // corridors of the same width without any feature of the ring
  elsewhere.add_box({0, 0}, {20, 20});
  elsewhere.add_box({-2.3, -2.2}, {22.4, 22.1});
  for (double at_m = -1.0; at_m < 20.0; at_m += 4.3) {
    elsewhere.add_box({at_m, -0.5}, {at_m + 0.4, -0.1});
    elsewhere.add_box({21.9, at_m}, {22.3, at_m + 0.8});
    elsewhere.add_box({at_m, 20.1}, {at_m + 0.2, 20.4});
  }
  for (const Submap& submap : carried_between(before_, drive(elsewhere, after_, 0.0)))
    closer_.add(submap);
  EXPECT_FALSE(closer_.is_connected());
  EXPECT_GT(closer_.counters().searches, 20U);
  EXPECT_EQ(closer_.counters().found_elsewhere, 0U);
}

TEST(LoopCloser, IgnoresSubmapsWithInvalidNumbers) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const auto submaps = drive(ring(), way_around_the_ring(0.4), 0.0);
  std::vector<Submap> faulty(6, submaps[1]);
  faulty[0].odom_from_submap.x_m = kNone;
  faulty[1].previous_from_submap.pose.heading_rad = std::numeric_limits<double>::infinity();
  faulty[2].previous_from_submap.covariance(1, 1) = kNone;
  faulty[3].submap_from_base_at_end.y_m = kNone;
  faulty[4].travelled_m = kNone;
  faulty[5].surfels.front().x_m = std::numeric_limits<float>::quiet_NaN();
  LoopCloser closer(indoor_loop_closing());
  EXPECT_TRUE(closer.add(faulty[0]).submaps.empty());
  closer.add(submaps[0]);
  for (const Submap& submap : faulty) EXPECT_EQ(closer.add(submap).submaps.size(), 1U);
  EXPECT_EQ(closer.counters().faulty_submaps, faulty.size() + 1);
  EXPECT_EQ(closer.add(submaps[1]).submaps.size(), 2U);
}

}  // namespace
}  // namespace slammot::loop_closing
