#include "services/localization/submap_sequence.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"

namespace slammot::localization {
namespace {

using geometry::Pose2;
using slammot::testing::PoseNear;

LocalizerConfig config_of_short_submaps() {
  LocalizerConfig config;
  config.map.side_m = 40.0;
  config.map.new_map_after_m = 100.0;
  config.map.new_map_after_travel_m = 10.0;
  return config;
}

/// A vehicle that goes straight on, with something ahead of it.
class SubmapSequenceTest : public ::testing::Test {
 protected:
  SubmapSequenceTest() { submaps_.begin(); }

  void see_something() {
    submaps_.map().integrate(
        ++stamp_ns_, odom_from_base_.translation_m(),
        {{odom_from_base_.translation_m() + geometry::Vector2(3.0, 0.0), grids::Echo::kStationary}},
        0.0);
  }

  void go(double way_m, const ScanMatch& match = {}) {
    submaps_.travel({way_m, 0.0, 0.0}, match);
    odom_from_base_.x_m += way_m;
  }

  SubmapSequence submaps_{config_of_short_submaps()};
  Pose2 odom_from_base_;
  std::int64_t stamp_ns_ = 0;
};

TEST_F(SubmapSequenceTest, EndsASubmapAfterTheConfiguredWay) {
  see_something();
  go(9.0);
  EXPECT_FALSE(submaps_.begin_next_if_due(odom_from_base_));
  go(2.0);
  EXPECT_TRUE(submaps_.begin_next_if_due(odom_from_base_));
  const auto ended = submaps_.take_finished();
  ASSERT_TRUE(ended);
  EXPECT_DOUBLE_EQ(ended->travelled_m, 11.0);
  EXPECT_GT(ended->saliency, 0.0);
  EXPECT_THAT(ended->submap_from_base_at_end,
              PoseNear(geometry::inverse(ended->odom_from_submap) * odom_from_base_, 1e-9));
  EXPECT_FALSE(submaps_.take_finished());
}

TEST_F(SubmapSequenceTest, TiesASubmapToTheOneBeforeByTheDriftOfTheWay) {
  see_something();
  go(16.0);
  submaps_.begin_next_if_due(odom_from_base_);
  see_something();
  submaps_.finish(odom_from_base_);
  const auto first = submaps_.take_finished();
  const auto second = submaps_.take_finished();
  ASSERT_TRUE(first && second);
  EXPECT_EQ(second->submap_id.value, first->submap_id.value + 1);
  EXPECT_THAT(
      second->previous_from_submap.pose,
      PoseNear(geometry::inverse(first->odom_from_submap) * second->odom_from_submap, 1e-9));
  EXPECT_NEAR(std::sqrt(second->previous_from_submap.covariance(0, 0)),
              LocalizerConfig{}.errors.drift_m_per_sqrt_m * 4.0, 1e-9);
}

TEST_F(SubmapSequenceTest, TiesASubmapAsLooselyAsTheMatchesThatItInheritsFrom) {
  ScanMatch unsure;
  unsure.new_share = 0.5;
  unsure.odom_from_base.covariance = Eigen::Vector3d(0.01, 0.01, 1e-4).asDiagonal();
  see_something();
  for (int step = 0; step < 110; ++step) go(0.1, unsure);
  ASSERT_TRUE(submaps_.begin_next_if_due(odom_from_base_));
  see_something();
  ASSERT_TRUE(submaps_.finish(odom_from_base_));
  ASSERT_TRUE(submaps_.take_finished());
  const auto next = submaps_.take_finished();
  ASSERT_TRUE(next);
  const double renewed = 110.0 * (1.0 - std::exp(-0.1 * 0.5 / 2.0));
  const geometry::Matrix3& covariance = next->previous_from_submap.covariance;
  EXPECT_NEAR(covariance(0, 0), renewed * 0.01, 1e-9);
  EXPECT_NEAR(covariance(2, 2), renewed * 1e-4, 1e-9);
}

TEST_F(SubmapSequenceTest, TiesASubmapLooselyAlongAMotionThatIsInDoubt) {
  see_something();
  go(11.0);
  submaps_.doubt({3.0, 0.0});
  ASSERT_TRUE(submaps_.begin_next_if_due(odom_from_base_));
  see_something();
  ASSERT_TRUE(submaps_.finish(odom_from_base_));
  ASSERT_TRUE(submaps_.take_finished());
  const auto next = submaps_.take_finished();
  ASSERT_TRUE(next);
  const geometry::Matrix3& covariance = next->previous_from_submap.covariance;
  EXPECT_NEAR(covariance(0, 0), 3.0, 0.01) << "evenly distributed up to 3 m";
  EXPECT_LT(covariance(1, 1), 0.01);
}

TEST_F(SubmapSequenceTest, TiesAnAstraySubmapByNextToNothingAndMakesTheNextOnesShort) {
  see_something();
  const std::int64_t lost_since_ns = stamp_ns_;
  stamp_ns_ += 10;
  EXPECT_TRUE(submaps_.begin_astray(odom_from_base_, lost_since_ns));
  EXPECT_FALSE(submaps_.map().has_echoes());
  see_something();
  go(5.0);
  EXPECT_TRUE(submaps_.begin_next_if_due(odom_from_base_)) << "10 m in submaps of known place";
  submaps_.take_finished();
  const auto astray = submaps_.take_finished();
  EXPECT_NEAR(std::sqrt(astray->previous_from_submap.covariance(0, 0)),
              LocalizerConfig{}.recovery.astray_sigma_m, 1e-9);
  EXPECT_EQ(astray->first_stamp_ns, lost_since_ns) << "the vehicle has been there since";
  see_something();
  submaps_.finish(odom_from_base_);
  EXPECT_EQ(submaps_.take_finished()->first_stamp_ns, stamp_ns_);
}

TEST_F(SubmapSequenceTest, FinishesNothingThatIsEmptyOrFinished) {
  EXPECT_FALSE(submaps_.finish(odom_from_base_));
  see_something();
  EXPECT_TRUE(submaps_.finish(odom_from_base_));
  EXPECT_FALSE(submaps_.finish(odom_from_base_));
}

TEST_F(SubmapSequenceTest, ForgetsTheWayThatIsUndone) {
  const SubmapSequence::Travel before = submaps_.travelled();
  go(20.0);
  submaps_.set_travelled(before);
  EXPECT_FALSE(submaps_.begin_next_if_due({}));
}

TEST_F(SubmapSequenceTest, TakesTheNewestCorrectionOnly) {
  submaps_.correct({.sequence = 2, .map_from_odom = {1.0, 2.0, 0.3}, .submaps = {}});
  submaps_.correct({.sequence = 1, .map_from_odom = {9.0, 9.0, 0.9}, .submaps = {}});
  EXPECT_THAT(submaps_.map_from_odom(), PoseNear(Pose2{1.0, 2.0, 0.3}, 1e-12));
}

TEST(SubmapSequence, FollowsTheLastSubmapOfAStoredMap) {
  SubmapSequence submaps(config_of_short_submaps());
  submaps.go_on_after({{7}, {1.0, 2.0, 0.3}});
  submaps.begin();
  EXPECT_EQ(submaps.map().submap_id().value, 8U);
  EXPECT_THAT(submaps.map_from_odom(), PoseNear(Pose2{1.0, 2.0, 0.3}, 1e-12));
}

}  // namespace
}  // namespace slammot::localization
