#include "services/localization/step_explanations.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"

namespace slammot::localization {
namespace {

using geometry::Pose2;
using sensing::StepExplanation;
using slammot::testing::PoseNear;

/// A vehicle at a place in odom, known to the centimetre, that has matched for a while; wheels
/// report a step of 0.1 s.
class StepExplanationsTest : public ::testing::Test {
 protected:
  StepExplanationsTest() {
    before_ = sensing::at_start(config_.motion);
    before_.odom_from_base = kBefore;
    before_.covariance.topLeftCorner<3, 3>() = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
    before_.velocity = {7.0, 0.7};  // as wheels have it
    belief_.matched_velocity = {5.0, 0.2};
    belief_.matched_velocity_variance = {0.04, 0.001};
  }

  StepExplanations explanations() const { return {before_, belief_, config_, config_.motion}; }

  Step by_wheels(const Pose2& before_from_base, double duration_s = 0.1) const {
    Step step;
    step.duration_s = duration_s;
    step.stamp_ns = static_cast<std::int64_t>(duration_s * 1e9);
    step.source = StepSource::kOdometry;
    step.odom_from_base_before = before_.uncertain_pose();
    step.wheels.uncorrected = before_from_base;
    step.before_from_base = before_from_base;
    step.after = sensing::moved_by_wheels(before_, {before_from_base, duration_s}, config_.motion);
    return step;
  }

  static double position_sigma_m(const Step& step) {
    return std::sqrt(step.prior().covariance.topLeftCorner<2, 2>().trace());
  }

  void learn(const sensing::WheelFactors& factors) {
    for (int i = 0; i < 40; ++i) {
      const Pose2 by_wheels{0.5, 0.0, 0.02 * (i % 5 - 2)};
      belief_.estimator.observe(
          by_wheels, {factors.way * by_wheels.x_m, 0.0, factors.turn * by_wheels.heading_rad}, 0.1);
    }
  }

  static constexpr Pose2 kBefore{3.0, -2.0, 0.5};
  LocalizerConfig config_;
  sensing::MotionEstimate before_;
  sensing::OdometryBelief belief_;
};

TEST_F(StepExplanationsTest, RoughWheelsPredictTheSamePoseLessSurely) {
  const Step step = by_wheels({0.7, 0.0, 0.05});
  const Step rough = explanations().rough(step);
  EXPECT_EQ(rough.explanation, StepExplanation::kRoughWheels);
  EXPECT_EQ(rough.after.odom_from_base, step.after.odom_from_base);
  EXPECT_GT(position_sigma_m(rough), 2.0 * position_sigma_m(step));
  EXPECT_LT(position_sigma_m(rough), 1.01 * config_.belief.rough_sigmas * position_sigma_m(step));
  EXPECT_TRUE(rough.is_by_wheels() && rough.wheels.are_overruled);
}

TEST_F(StepExplanationsTest, KnowNoOtherFactorsBeforeTheyAreLearned) {
  EXPECT_FALSE(explanations().recalibrated(by_wheels({0.7, 0.0, 0.05})));
}

TEST_F(StepExplanationsTest, RecalibratedWheelsPredictByTheFactorsThatMatchesSuggest) {
  learn({.way = 1.0 / 1.3, .turn = -1.0});
  const auto recalibrated = explanations().recalibrated(by_wheels({0.65, 0.0, 0.05}));
  ASSERT_TRUE(recalibrated);
  EXPECT_EQ(recalibrated->explanation, StepExplanation::kRecalibrated);
  EXPECT_THAT(recalibrated->after.odom_from_base,
              PoseNear(kBefore * Pose2{0.5, -0.0125, -0.05}, 0.02));
}

TEST_F(StepExplanationsTest, WithoutOdometryTheVelocityOfTheMatchesPredicts) {
  const Step other = explanations().other(by_wheels({0.7, 0.0, 0.07}));
  EXPECT_EQ(other.explanation, StepExplanation::kOther);
  EXPECT_EQ(other.source, StepSource::kVelocityAlone);
  EXPECT_THAT(other.after.odom_from_base, PoseNear(kBefore * Pose2{0.5, 0.005, 0.02}, 0.01));
  EXPECT_TRUE(other.has_wheels()) << "odometry spoke, though it is not believed";
}

TEST_F(StepExplanationsTest, WithoutOdometryForTheSecondTimeTheEstimateKnowsTheVelocity) {
  belief_.last = StepExplanation::kOther;
  before_.velocity = {4.0, 0.0};
  const Step other = explanations().other(by_wheels({0.7, 0.0, 0.07}));
  EXPECT_THAT(other.after.odom_from_base, PoseNear(kBefore * Pose2{0.4, 0.0, 0.0}, 0.001));
}

TEST_F(StepExplanationsTest, WithoutOdometryNothingIsTakenToStand) {
  Step standing = by_wheels({});
  standing.wheels.is_standing = true;
  standing.wheels.stood_s = 3.0;
  const Step other = explanations().other(standing);
  EXPECT_FALSE(other.wheels.is_standing);
  EXPECT_EQ(other.wheels.stood_s, 0.0);
}

TEST_F(StepExplanationsTest, WithoutOdometryStepsLikeThoseBeforeAreNarrowerThanReach) {
  belief_.last_step = {0.9, 0.1, 0.2};
  belief_.usual_drive_m = 1.0;
  belief_.usual_turn_rad = 0.5;
  const Step step = explanations().without_odometry(by_wheels({}));
  const auto expected = [&](const Pose2& before_from_base) { return kBefore * before_from_base; };
  EXPECT_THAT(explanations().like_the_last(step).after.odom_from_base,
              PoseNear(expected({0.9, 0.1, 0.2}), 1e-9));
  EXPECT_THAT(explanations().straight_on(step).after.odom_from_base,
              PoseNear(expected({1.0, 0.0, 0.0}), 1e-9));
  EXPECT_THAT(explanations().to_the_left(step).after.odom_from_base,
              PoseNear(expected({0.0, 0.0, 0.5}), 1e-9));
  EXPECT_THAT(explanations().to_the_right(step).after.odom_from_base,
              PoseNear(expected({0.0, 0.0, -0.5}), 1e-9));
  EXPECT_LT(explanations().straight_on(step).after.covariance(0, 0),
            0.5 * step.after.covariance(0, 0));
}

TEST_F(StepExplanationsTest, ReachGrowsWithTheWayWhereNoTimeIsKnown) {
  config_.odometry.time_is_known = false;
  const Step near = explanations().other(by_wheels({0.1, 0.0, 0.0}));
  const Step far = explanations().other(by_wheels({2.0, 0.0, 0.0}));
  EXPECT_THAT(far.after.odom_from_base, PoseNear(kBefore * Pose2{2.0, 0.0, 0.0}, 1e-9));
  EXPECT_GE(position_sigma_m(near), config_.belief.reach_m);
  EXPECT_GT(position_sigma_m(far), position_sigma_m(near) + 0.5);
}

TEST_F(StepExplanationsTest, TheUsualDurationIsThatOfTheStepsSoFarFromTheFirstOneOn) {
  const Step step = by_wheels({1.0, 0.0, 0.0}, 1.0);
  EXPECT_DOUBLE_EQ(usual_duration_so_far_s(step, {}, config_.belief), 1.0);
  sensing::OdometryBelief belief;
  for (int i = 0; i < 3; ++i)
    belief = sensing::moved(belief, StepExplanation::kOther, 0.8, Pose2{1.0, 0.0, 0.0},
                            config_.motion, config_.belief);
  EXPECT_LT(belief.usual_step_s, 0.4);
  EXPECT_NEAR(usual_duration_so_far_s(step, belief, config_.belief), 0.8, 1e-9);
}

TEST_F(StepExplanationsTest, ReachCountsWhereScansAreRare) {
  Step rare = by_wheels({0.7, 0.0, 0.0}, 2.0);
  rare.usual_duration_s = 2.0;
  const Step other = explanations().other(rare);
  EXPECT_EQ(other.source, StepSource::kOdometry);
  EXPECT_THAT(other.after.odom_from_base, PoseNear(kBefore * Pose2{0.7, 0.0, 0.0}, 1e-9));
  EXPECT_GE(position_sigma_m(other), config_.belief.reach_m);
}

}  // namespace
}  // namespace slammot::localization
