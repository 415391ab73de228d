#include "common/metrics/trajectory.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"

namespace slammot::metrics {
namespace {

using geometry::Pose2;
using testing::PoseNear;

constexpr std::int64_t kMs = 1'000'000;

/// Along x, one metre and one second a pose.
Trajectory straight(int poses, double step_m = 1.0) {
  Trajectory trajectory;
  for (int i = 0; i < poses; ++i) trajectory.push_back({1000 * kMs * i, {step_m * i, 0.0, 0.0}});
  return trajectory;
}

Trajectory moved(const Trajectory& trajectory, const Pose2& by) {
  Trajectory result;
  for (const StampedPose& pose : trajectory) result.push_back({pose.stamp_ns, by * pose.pose});
  return result;
}

std::vector<Pose2> poses_at(const std::vector<double>& places_m) {
  std::vector<Pose2> poses;
  for (const double place_m : places_m) poses.push_back({place_m, 0.0, 0.0});
  return poses;
}

TEST(Associate, TakesTheNearestInTimeWithinTheTolerance) {
  const Trajectory truth = {{0, {0, 0, 0}}, {100 * kMs, {1, 0, 0}}, {200 * kMs, {2, 0, 0}}};
  const Trajectory estimate = {{104 * kMs, {5, 0, 0}}, {150 * kMs, {6, 0, 0}}};
  const auto pairs = associate(truth, estimate, 10 * kMs);
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs[0].truth.x_m, 1.0);
  EXPECT_EQ(pairs[0].estimate.x_m, 5.0);
}

TEST(Associate, GivesEachPoseOfTheShorterTrajectoryOnePartner) {
  EXPECT_EQ(associate(straight(10), straight(4), 10 * kMs).size(), 4U);
  EXPECT_EQ(associate(straight(4), straight(10), 10 * kMs).size(), 4U);
}

TEST(Associate, FindsNothingWhereTheClocksDoNotOverlap) {
  Trajectory later = straight(5);
  for (StampedPose& pose : later) pose.stamp_ns += 1'000'000 * kMs;
  EXPECT_TRUE(associate(straight(5), later, 10 * kMs).empty());
}

TEST(PoseAt, LiesBetweenNeighbours) {
  const auto pose = pose_at(straight(3), 1250 * kMs, 2000 * kMs);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->x_m, 1.25, 1e-12);
}

TEST(PoseAt, IsUnknownInALongGapAndOutside) {
  EXPECT_FALSE(pose_at(straight(3), 1250 * kMs, 500 * kMs));
  EXPECT_FALSE(pose_at(straight(3), 9000 * kMs, 500 * kMs));
  EXPECT_FALSE(pose_at(straight(3), -1, 500 * kMs));
}

TEST(AlignRigidly, FindsTheMotionBetweenEqualTrajectories) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-10.0, 10.0);
  Trajectory truth;
  for (int i = 0; i < 20; ++i)
    truth.push_back({i, {uniform(random), uniform(random), uniform(random)}});
  const Pose2 world_from_map{3.0, -2.0, 2.5};
  const auto pairs = associate(truth, moved(truth, geometry::inverse(world_from_map)), 0);
  EXPECT_THAT(align_rigidly(pairs), PoseNear(world_from_map, 1e-12));
  EXPECT_THAT(align_first_pose(pairs), PoseNear(world_from_map, 1e-12));
}

TEST(AbsoluteError, OfATrajectoryHalfAMetreAsideAtEveryOtherPoseIsAQuarterAfterAlignment) {
  const Trajectory truth = straight(4);
  Trajectory estimate = truth;
  for (std::size_t i : {1U, 2U})
    estimate[i].pose.y_m = 0.5;  // symmetric, so that alignment does not turn it
  const auto pairs = associate(truth, estimate, 0);
  ASSERT_EQ(pairs.size(), truth.size());
  for (const double error_m : absolute_errors_m(pairs, align_rigidly(pairs)))
    EXPECT_NEAR(error_m, 0.25, 1e-12);
}

TEST(PairsByPath, ConsecutiveOnesBeginWhereTheLastEnded) {
  const auto pairs =
      pairs_by_path(poses_at({0, 0.6, 1.2, 1.8, 2.4, 3.0}), 1.0, PathPairs::kConsecutive);
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_EQ(pairs[0].from, 0U);
  EXPECT_EQ(pairs[0].to, 2U);
  EXPECT_EQ(pairs[1].from, 2U);
  EXPECT_EQ(pairs[1].to, 4U);
}

TEST(PairsByPath, AllBeginAtEachPoseAndLeaveOutWhatIsNotNearEnough) {
  const auto pairs = pairs_by_path(poses_at({0, 0.5, 1.05, 1.5, 2.7}), 1.0, PathPairs::kAll);
  ASSERT_EQ(pairs.size(), 2U);  // 0 to 1.05 and 0.5 to 1.5; from 1.05 and 1.5 nothing is within 0.1
                                // of a metre away
  EXPECT_EQ(pairs[0].to, 2U);
  EXPECT_EQ(pairs[1].to, 3U);
}

TEST(PairsByPath, AllEndAtTheFirstPoseOfARest) {
  const auto pairs = pairs_by_path(poses_at({0, 1, 1, 1}), 1.0, PathPairs::kAll);
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs[0].to, 1U);
}

TEST(RelativeErrors, OfAScaleOffByOnePercentAreAHundredthOfTheWay) {
  const auto pairs = associate(straight(31), straight(31, 1.01), 0);
  const auto errors = relative_errors(pairs, {{0, 10}, {10, 20}, {20, 30}});
  ASSERT_EQ(errors.size(), 3U);
  for (const RelativeError& error : errors) {
    EXPECT_NEAR(error.translation_m, 0.1, 1e-12);
    EXPECT_NEAR(error.rotation_rad, 0.0, 1e-12);
  }
}

TEST(RelativeErrors, DoNotDependOnTheFrameOfEither) {
  const auto plain = relative_errors(associate(straight(11), straight(11, 1.01), 0), {{0, 10}});
  const auto turned = relative_errors(
      associate(straight(11), moved(straight(11, 1.01), {5.0, 6.0, 0.7}), 0), {{0, 10}});
  EXPECT_NEAR(plain[0].translation_m, turned[0].translation_m, 1e-12);
}

TEST(RelativePoseNees, IsTheSquaredErrorInUnitsOfTheTwoCovariancesTogether) {
  const double sigma_m = 0.1;
  std::vector<UncertainStampedPose> estimate;
  for (const StampedPose& pose : straight(3)) {
    estimate.push_back(
        {pose.stamp_ns, {pose.pose, geometry::Matrix3::Identity() * sigma_m * sigma_m}});
  }
  estimate[1].odom_from_base.pose.y_m = 0.2;
  estimate.front().odom_from_base.covariance(2, 2) =
      estimate.back().odom_from_base.covariance(2, 2) = 1e-12;  // no lever arm
  const auto nees = relative_pose_nees(straight(3), estimate, 1000 * kMs, 10 * kMs);
  ASSERT_EQ(nees.size(), 2U);
  EXPECT_NEAR(nees[0], 0.2 * 0.2 / (2.0 * sigma_m * sigma_m), 1e-6);
}

TEST(RelativePoseNees, UsesIntervalsThatDoNotOverlap) {
  std::vector<UncertainStampedPose> estimate;
  for (const StampedPose& pose : straight(9))
    estimate.push_back({pose.stamp_ns, {pose.pose, geometry::Matrix3::Identity()}});
  EXPECT_EQ(relative_pose_nees(straight(9), estimate, 2000 * kMs, 10 * kMs).size(), 4U);
}

}  // namespace
}  // namespace slammot::metrics
