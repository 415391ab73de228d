#include "services/localization/scan_matcher.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/mapped_world.hpp"
#include "tests/support/matchers.hpp"

namespace slammot::localization {
namespace {

using geometry::Pose2;
using slammot::testing::MappedWorld;
using slammot::testing::PoseNear;

/// A prediction with one sigma of position and heading.
Step step_to(const Pose2& odom_from_base, double sigma_m, double sigma_rad,
             StepSource source = StepSource::kOdometry) {
  Step step;
  step.source = source;
  step.after.odom_from_base = odom_from_base;
  step.after.covariance.topLeftCorner<3, 3>() =
      Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad).asDiagonal();
  return step;
}

class ScanMatcherTest : public ::testing::Test {
 protected:
  /// Of the scan at the pose.
  ScanMatch match_at(const Pose2& truth, const Step& step) {
    const ScanPoints points = room_.points_at(truth);
    return matcher_.match({points.matched(), room_.map().surfels(), step, 1});
  }

  MappedWorld room_{slammot::testing::room()};
  ScanMatcher matcher_{room_.config()};
};

TEST_F(ScanMatcherTest, FindsThePoseNearThePrediction) {
  const Pose2 truth{0.3, 0.2, 0.1};
  const ScanMatch match = match_at(truth, step_to({0.35, 0.17, 0.11}, 0.1, 0.015));
  EXPECT_TRUE(match.is_believed);
  EXPECT_FALSE(match.was_searched || match.was_sampled || match.is_lost);
  EXPECT_THAT(match.odom_from_base.pose, PoseNear(truth, 0.03));
  EXPECT_LT(match.rms_residual_m, 0.05);
}

TEST_F(ScanMatcherTest, SearchesWhereThePredictionIsVague) {
  const Pose2 truth{0.3, 0.2, 0.1};
  const ScanMatch match =
      match_at(truth, step_to({1.3, -0.6, 0.3}, 1.0, 0.2, StepSource::kVelocityAlone));
  EXPECT_TRUE(match.was_searched);
  EXPECT_THAT(match.odom_from_base.pose, PoseNear(truth, 0.05));
}

TEST_F(ScanMatcherTest, SearchesTheWholeMapWhereNothingIsKnown) {
  const Pose2 truth{-2.0, 1.0, 2.5};
  const ScanMatch match =
      match_at(truth, step_to({4.0, -1.0, -0.5}, 10.0, 3.0, StepSource::kVelocityAlone));
  EXPECT_TRUE(match.was_searched);
  EXPECT_THAT(match.odom_from_base.pose, PoseNear(truth, 0.05));
}

TEST_F(ScanMatcherTest, SaysThatAScanOfAnotherPlaceDoesNotMatch) {
  const MappedWorld elsewhere(slammot::testing::box({0.0, 0.0, 0.7}, 30.0, 26.0));
  const ScanPoints points = elsewhere.points_at({0.0, 0.0, 0.0});
  const ScanMatch match = matcher_.match(
      {points.matched(), room_.map().surfels(), step_to({0.1, 0.0, 0.0}, 0.1, 0.01), 1});
  EXPECT_TRUE(match.is_lost);
  EXPECT_FALSE(match.is_believed);
  EXPECT_EQ(match.odom_from_base.pose, (Pose2{0.1, 0.0, 0.0}));
}

TEST_F(ScanMatcherTest, KeepsThePredictionWhereThereAreTooFewPoints) {
  const ScanMatch match = matcher_.match(
      {{{{1.0, 0.0}}}, room_.map().surfels(), step_to({0.1, 0.0, 0.0}, 0.1, 0.01), 1});
  EXPECT_FALSE(match.is_believed || match.is_lost);
  EXPECT_EQ(match.odom_from_base.pose, (Pose2{0.1, 0.0, 0.0}));
}

TEST_F(ScanMatcherTest, LeavesTheDirectionAlongAWallToThePrediction) {
  const MappedWorld wall({{{-200.0, 3.0}, {200.0, 3.0}}});
  const ScanPoints points = wall.points_at({0.0, 0.0, 0.0});
  const ScanMatch match = matcher_.match(
      {points.matched(), wall.map().surfels(), step_to({0.2, 0.05, 0.0}, 0.1, 0.01), 1});
  EXPECT_TRUE(match.was_sampled);
  EXPECT_NEAR(match.odom_from_base.pose.x_m, 0.2, 0.05);
  EXPECT_NEAR(match.odom_from_base.pose.y_m, 0.0, 0.03);
  EXPECT_EQ(match.new_share, 0.0);
}

/// A car before a vehicle that stands in a street has most of the echoes, and begins to drive off.
TEST_F(ScanMatcherTest, IsNotTurnedByACarAheadWhereTheWheelsTurnsAreNoise) {
  const auto street = [](double turned_m) {
    return MappedWorld({{{-40.0, 12.0}, {40.0, 12.0}},
                        {{-40.0, -9.0}, {40.0, -9.0}},
                        {{4.0, -1.0}, {4.0 + turned_m, 1.0}}});
  };
  const MappedWorld before = street(0.0);
  const MappedWorld now = street(0.06);
  const ScanPoints points = now.points_at({0.0, 0.0, 0.0});
  const auto turned_rad = [&](double turn_variance_rad2) {
    Step step = step_to({0.0, 0.0, 0.0}, 0.01, 0.015);
    step.wheels.turn_variance_rad2 = turn_variance_rad2;
    return std::abs(matcher_.match({points.matched(), before.map().surfels(), step, 1})
                        .odom_from_base.pose.heading_rad);
  };
  EXPECT_LT(turned_rad(1e-5), 0.5 * turned_rad(0.0));
}

TEST_F(ScanMatcherTest, RegistersFromAnyPoseWithoutJudging) {
  const Pose2 truth{0.3, 0.2, 0.1};
  const ScanPoints points = room_.points_at(truth);
  const Step step = step_to({5.0, 5.0, 0.0}, 0.1, 0.01);
  const geometry::Matrix3 wide = Eigen::Vector3d(100.0, 100.0, 9.0).asDiagonal();
  const auto result = matcher_.register_from({0.4, 0.1, 0.12}, {{0.4, 0.1, 0.12}, wide},
                                             {points.matched(), room_.map().surfels(), step, 1});
  EXPECT_THAT(result.map_from_base.pose, PoseNear(truth, 0.03));
}

}  // namespace
}  // namespace slammot::localization
