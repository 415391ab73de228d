#include "common/sensing/odometry_belief.hpp"

#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "tests/support/matchers.hpp"

namespace slammot::sensing {
namespace {

using geometry::Matrix3;
using geometry::Pose2;
using geometry::UncertainPose2;
using slammot::testing::PoseNear;

constexpr double kNever = -std::numeric_limits<double>::infinity();

Matrix3 diagonal(double x, double y, double heading) {
  return Eigen::Vector3d(x, y, heading).asDiagonal();
}

double sum(const ExplanationWeights& weights) {
  return std::accumulate(weights.begin(), weights.end(), 0.0);
}

/// A prediction whose errors in x, y and heading depend on each other.
UncertainPose2 prediction() {
  Matrix3 root;
  root << 0.3, 0.0, 0.0, 0.1, 0.2, 0.0, 0.02, -0.03, 0.1;
  return {{1.0, 2.0, 0.3}, root * root.transpose()};
}

Matrix3 example_information() {
  Matrix3 root;
  root << 4.0, 0.0, 0.0, -1.0, 6.0, 0.0, 2.0, 3.0, 9.0;
  return root * root.transpose();
}

/// Mean of the scan's likelihood over samples of the prediction.
double likelihood_by_monte_carlo(const UncertainPose2& prediction, const Pose2& optimum,
                                 const Matrix3& information) {
  constexpr int kSamples = 400000;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const Matrix3 root = prediction.covariance.llt().matrixL();
  const Eigen::Vector3d apart = geometry::difference(optimum, prediction.pose);
  double likelihood = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const Eigen::Vector3d error =
        root * Eigen::Vector3d(normal(random), normal(random), normal(random)) - apart;
    likelihood += std::exp(-0.5 * error.dot(information * error));
  }
  return likelihood / kSamples;
}

TEST(LogMarginalLikelihood, IsThatOfMonteCarloIntegration) {
  for (const Pose2& optimum : {Pose2{1.0, 2.0, 0.3}, Pose2{1.4, 1.8, 0.2}, Pose2{0.5, 2.3, 0.45}}) {
    const double expected = likelihood_by_monte_carlo(prediction(), optimum, example_information());
    EXPECT_NEAR(std::exp(log_marginal_likelihood(prediction(), optimum, example_information())),
                expected, 0.02 * expected);
  }
}

TEST(LogMarginalLikelihood, IsThatOfMonteCarloIntegrationWhereTheScanSaysNothingOfADirection) {
  const Matrix3 along_a_wall = diagonal(0.0, 400.0, 900.0);
  const double expected = likelihood_by_monte_carlo(prediction(), {7.0, 1.9, 0.25}, along_a_wall);
  EXPECT_NEAR(std::exp(log_marginal_likelihood(prediction(), {7.0, 1.9, 0.25}, along_a_wall)),
              expected, 0.02 * expected);
}

TEST(LogMarginalLikelihood, IsTheSameForEveryPredictionOfAScanThatSaysNothing) {
  EXPECT_EQ(log_marginal_likelihood(prediction(), {50.0, -3.0, 1.0}, Matrix3::Zero()), 0.0);
}

TEST(LogMarginalLikelihood, DependsOnNothingThatTheScanDoesNotObserve) {
  const Matrix3 along_a_wall = diagonal(0.0, 400.0, 900.0);
  const UncertainPose2 sure{{1.0, 2.0, 0.3}, diagonal(0.01, 0.01, 0.001)};
  UncertainPose2 elsewhere_along_it = sure;
  elsewhere_along_it.pose.x_m += 5.0;
  elsewhere_along_it.covariance(0, 0) = 4.0;
  EXPECT_NEAR(log_marginal_likelihood(sure, {1.0, 2.1, 0.3}, along_a_wall),
              log_marginal_likelihood(elsewhere_along_it, {1.0, 2.1, 0.3}, along_a_wall), 1e-12);
}

TEST(LogMarginalLikelihood,
     PrefersTheSurePredictionThatIsRightAndTheVagueOneToASureOneThatIsWrong) {
  const UncertainPose2 sure{{}, diagonal(1e-4, 1e-4, 1e-6)};
  const UncertainPose2 vague{{}, diagonal(0.25, 0.25, 0.01)};
  const Matrix3 information = diagonal(1e4, 1e4, 1e6);
  EXPECT_GT(log_marginal_likelihood(sure, {0.005, 0.0, 0.0}, information),
            log_marginal_likelihood(vague, {0.005, 0.0, 0.0}, information));
  EXPECT_LT(log_marginal_likelihood(sure, {0.5, 0.0, 0.0}, information),
            log_marginal_likelihood(vague, {0.5, 0.0, 0.0}, information));
}

TEST(LogMarginalLikelihood, CountsHeadingsTheShorterWayRound) {
  const UncertainPose2 backwards{{0.0, 0.0, 3.1}, diagonal(0.01, 0.01, 0.01)};
  EXPECT_NEAR(log_marginal_likelihood(backwards, {0.0, 0.0, -3.1}, diagonal(1.0, 1.0, 100.0)),
              log_marginal_likelihood(backwards, {0.0, 0.0, 3.1 - (2.0 * M_PI - 6.2)},
                                      diagonal(1.0, 1.0, 100.0)),
              1e-9);
}

/// The posterior's mode of two Gaussians.
Pose2 maximum_a_posteriori(const UncertainPose2& prediction, const Pose2& optimum,
                           const Matrix3& information) {
  const Matrix3 by_prediction = prediction.covariance.inverse();
  const Eigen::Vector3d step =
      (by_prediction + information)
          .ldlt()
          .solve(information * geometry::difference(optimum, prediction.pose));
  return {prediction.pose.x_m + step.x(), prediction.pose.y_m + step.y(),
          prediction.pose.heading_rad + step.z()};
}

TEST(ScanOptimum, UndoesThePullOfThePrediction) {
  const Matrix3 information = 100.0 * example_information();
  const Pose2 optimum{1.4, 1.7, 0.5};
  const Pose2 matched = maximum_a_posteriori(prediction(), optimum, information);
  EXPECT_THAT(scan_optimum(prediction(), matched, information), PoseNear(optimum, 0.01));
}

TEST(ScanOptimum, StaysAtTheMatchWhereTheScanSaysNothing) {
  const Matrix3 along_a_wall = diagonal(0.0, 40000.0, 90000.0);
  const UncertainPose2 sure{{}, diagonal(1e-4, 1e-4, 1e-6)};
  const Pose2 optimum{3.0, 0.02, 0.001};
  const Pose2 matched = maximum_a_posteriori(sure, optimum, along_a_wall);
  const Pose2 found = scan_optimum(sure, matched, along_a_wall);
  EXPECT_NEAR(found.x_m, 0.0, 1e-9);
  EXPECT_NEAR(found.y_m, 0.02, 0.001);
}

TEST(PredictedWeights, SumToOneAndReturnToTheirPriorsInTheLongRun) {
  const OdometryBeliefConfig config;
  ExplanationWeights weights{0.0, 0.0, 0.0, 1.0};
  for (int scan = 0; scan < 400; ++scan) {
    weights = predicted(weights, config);
    ASSERT_NEAR(sum(weights), 1.0, 1e-9);
  }
  EXPECT_NEAR(weights[index_of(StepExplanation::kOther)], config.other_prior, 1e-6);
  EXPECT_NEAR(weights[index_of(StepExplanation::kRoughWheels)], config.rough_prior, 1e-6);
  EXPECT_NEAR(weights[index_of(StepExplanation::kRecalibrated)], config.recalibrated_prior, 1e-6);
}

TEST(PredictedWeights, NeverRuleAnExplanationOut) {
  for (const double weight : predicted({1.0, 0.0, 0.0, 0.0}, OdometryBeliefConfig{}))
    EXPECT_GT(weight, 0.0);
}

TEST(UpdatedWeights, FollowBayesRule) {
  const ExplanationWeights posterior =
      updated({0.5, 0.25, 0.15, 0.1}, {std::log(0.1), std::log(0.4), std::log(0.2), std::log(0.8)});
  const double evidence = 0.5 * 0.1 + 0.25 * 0.4 + 0.15 * 0.2 + 0.1 * 0.8;
  EXPECT_NEAR(sum(posterior), 1.0, 1e-12);
  EXPECT_NEAR(posterior[0], 0.05 / evidence, 1e-12);
  EXPECT_NEAR(posterior[1], 0.10 / evidence, 1e-12);
  EXPECT_NEAR(posterior[2], 0.03 / evidence, 1e-12);
  EXPECT_NEAR(posterior[3], 0.08 / evidence, 1e-12);
}

TEST(UpdatedWeights, GiveNothingToAnExplanationThatIsNotAvailable) {
  const ExplanationWeights posterior = updated({0.4, 0.3, 0.2, 0.1}, {-5.0, -5.0, kNever, -5.0});
  EXPECT_EQ(posterior[2], 0.0);
  EXPECT_NEAR(sum(posterior), 1.0, 1e-12);
}

TEST(UpdatedWeights, StandHoweverUnlikelyTheScanIs) {
  const ExplanationWeights posterior =
      updated({0.9, 0.05, 0.03, 0.02}, {-1e6, -2e6, -3e6, -1e6 - 1.0});
  EXPECT_NEAR(sum(posterior), 1.0, 1e-12);
  EXPECT_EQ(most_likely(posterior), StepExplanation::kWheels);
}

/// Steps as wheels have them that are wrong by these factors, on a way with bends and a halt.
WheelFactorEstimator after_steps(const WheelFactors& truth, int steps, double noise_m = 0.0,
                                 double noise_rad = 0.0) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  WheelFactorEstimator estimator;
  for (int step = 0; step < steps; ++step) {
    const double turn_rad = 0.03 * std::sin(0.3 * step);
    const Pose2 by_wheels{0.1, 0.0, turn_rad};
    const Pose2 by_matches{
        truth.way * by_wheels.x_m + noise_m * normal(random), 0.0,
        truth.turn * turn_rad + truth.turn_bias_radps * 0.1 + noise_rad * normal(random)};
    estimator.observe(by_wheels, by_matches, 0.1);
  }
  return estimator;
}

TEST(WheelFactorEstimator, LearnsThatTheWayIsShort) {
  const WheelFactorEstimator estimator = after_steps({.way = 1.0 / 1.3}, 40);
  EXPECT_TRUE(estimator.is_known());
  EXPECT_NEAR(estimator.factors().way, 1.0 / 1.3, 0.01);
  EXPECT_NEAR(estimator.factors().turn, 1.0, 0.02);
}

TEST(WheelFactorEstimator, LearnsThatTurnsHaveTheWrongSign) {
  const WheelFactorEstimator estimator = after_steps({.turn = -1.0}, 40);
  EXPECT_NEAR(estimator.factors().turn, -1.0, 0.05);
  EXPECT_NEAR(estimator.factors().turn_bias_radps, 0.0, 0.01);
}

TEST(WheelFactorEstimator, LearnsAConstantYawBias) {
  const WheelFactorEstimator estimator = after_steps({.turn_bias_radps = 0.08}, 60);
  EXPECT_NEAR(estimator.factors().turn_bias_radps, 0.08, 0.01);
  EXPECT_NEAR(estimator.factors().turn, 1.0, 0.1);
}

TEST(WheelFactorEstimator, LearnsAllThreeFromNoisyMatches) {
  const WheelFactorEstimator estimator =
      after_steps({.way = 1.3, .turn = 0.87, .turn_bias_radps = -0.05}, 300, 0.01, 0.005);
  EXPECT_NEAR(estimator.factors().way, 1.3, 3.0 * estimator.way_sigma());
  EXPECT_NEAR(estimator.factors().turn, 0.87, 3.0 * estimator.turn_sigma());
  EXPECT_NEAR(estimator.factors().turn_bias_radps, -0.05, 0.02);
  EXPECT_LT(estimator.way_sigma(), 0.05);
}

TEST(WheelFactorEstimator, TakesNoiseOfTheHeadingForNoTurns) {
  // Encoders that count centimetres, 37 scans a second: on a straight way a factor of zero would
  // fit best.
  std::mt19937 random(1);
  std::normal_distribution<double> turn_rad(0.0, 0.01);
  std::normal_distribution<double> of_matches_rad(0.0, 0.001);
  WheelFactorEstimator estimator;
  for (int step = 0; step < 500; ++step)
    estimator.observe({0.25, 0.0, turn_rad(random)}, {0.25, 0.0, of_matches_rad(random)}, 0.027,
                      false);
  EXPECT_NEAR(estimator.factors().turn, 1.0, 0.05);
  EXPECT_GT(estimator.turn_sigma(), 1.0);
}

TEST(WheelFactorEstimator, KnowsNothingOfWheelsThatStand) {
  WheelFactorEstimator estimator;
  for (int step = 0; step < 100; ++step) estimator.observe({}, {0.1, 0.0, 0.0}, 0.1);
  EXPECT_FALSE(estimator.is_known());
  EXPECT_EQ(estimator.factors().way, 1.0);
}

TEST(WheelFactorEstimator, TakesWheelsThatSpinForNoFactor) {
  WheelFactorEstimator estimator;
  for (int step = 0; step < 200; ++step) {
    estimator.observe({0.027, 0.0, 0.0}, {}, 0.027);
    EXPECT_FALSE(estimator.is_known()) << "after " << step << " steps";
  }
}

TEST(WheelFactorEstimator, KnowsNothingAfterAFewSteps) {
  EXPECT_FALSE(after_steps({.way = 1.3}, 3).is_known());
}

TEST(CorrectedStep, IsTheSameByFactorsOfOne) {
  EXPECT_THAT(corrected({0.3, -0.02, 0.1}, 0.1, {}), PoseNear(Pose2{0.3, -0.02, 0.1}, 1e-12));
}

TEST(CorrectedStep, GoesTheWayAlongTheCorrectedArc) {
  constexpr double kTurn_rad = 0.2;
  const auto arc = [](double way_m, double turn_rad) {
    return Pose2{way_m / turn_rad * std::sin(turn_rad),
                 way_m / turn_rad * (1.0 - std::cos(turn_rad)), turn_rad};
  };
  EXPECT_THAT(corrected(arc(0.5, kTurn_rad), 0.1, {.way = 1.3, .turn = -1.0}),
              PoseNear(arc(0.65, -kTurn_rad), 0.001));
  EXPECT_THAT(corrected(arc(0.5, kTurn_rad), 2.0, {.turn_bias_radps = 0.05}),
              PoseNear(arc(0.5, kTurn_rad + 0.1), 0.002));
}

OdometryBelief after_straight_steps(int steps,
                                    StepExplanation explanation = StepExplanation::kWheels) {
  OdometryBelief belief;
  for (int step = 0; step < steps; ++step)
    belief = moved(belief, explanation, 0.2, Pose2{1.0, 0.0, 0.02}, MotionModelConfig{},
                   OdometryBeliefConfig{});
  return belief;
}

TEST(HasChanged, SeesASlipThatBeginsAtAnyTimeWithinAStepAndNoBraking) {
  constexpr double kStep_s = 1.0 / 37.5;
  const auto change_seen = [&](double speed_mps, double change_mps2, double jump_mps,
                               double first_share) {
    OdometryBelief belief;
    bool is_seen = false;
    for (int i = 0; i < 6; ++i) {
      const double jumped = i < 2 ? 0.0 : i == 2 ? first_share : 1.0;
      const Pose2 step{(speed_mps + change_mps2 * i * kStep_s + jumped * jump_mps) * kStep_s, 0.0,
                       0.0};
      is_seen = is_seen || has_changed(belief, step, kStep_s);
      belief = with_wheels(belief, step, kStep_s);
    }
    return is_seen;
  };
  for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0})
    EXPECT_TRUE(change_seen(6.0, 0.0, 1.0, share)) << share;
  EXPECT_FALSE(change_seen(6.0, -7.0, 0.0, 0.0));
}

TEST(OdometryBelief, AsksForNewComparisonsAfterAnImpossibleChange) {
  OdometryBelief belief;
  belief.log_odds = 4.0;
  belief = with_changed_wheels(belief);
  EXPECT_LE(belief.log_odds, 1.0);
  belief.log_odds = -3.0;
  belief.is_disbelieved = true;
  EXPECT_EQ(with_changed_wheels(belief).log_odds, -3.0) << "it is disbelieved already";
}

TEST(OdometryBelief, KnowsTheVelocityOfTheMatches) {
  const OdometryBelief belief = after_straight_steps(20);
  EXPECT_NEAR(belief.matched_velocity.x(), 5.0, 0.05);
  EXPECT_NEAR(belief.matched_velocity.y(), 0.1, 0.01);
}

TEST(OdometryBelief, GrowsUnsureOfTheVelocityWithoutMatches) {
  const OdometryBelief before = after_straight_steps(20);
  const OdometryBelief after = moved(before, StepExplanation::kWheels, 1.0, std::nullopt,
                                     MotionModelConfig{}, OdometryBeliefConfig{});
  EXPECT_EQ(after.matched_velocity, before.matched_velocity);
  EXPECT_GT(after.matched_velocity_variance.x(), before.matched_velocity_variance.x());
}

TEST(OdometryBelief, KnowsHowFarScansAreApartAndWhatExplainedTheLastOne) {
  const OdometryBelief belief = after_straight_steps(80, StepExplanation::kRoughWheels);
  EXPECT_NEAR(belief.usual_step_s, 0.2, 0.001);
  EXPECT_EQ(belief.last, StepExplanation::kRoughWheels);
}

TEST(OdometryBelief, GivesWheelsThatCountAgainAnotherChance) {
  OdometryBelief belief;
  belief.is_disbelieved = true;
  belief.log_odds = -4.0;
  belief = with_wheels(belief, {0.0, 0.0, 0.0}, 0.1);
  EXPECT_TRUE(belief.is_disbelieved);
  belief = with_wheels(belief, {0.0, 0.0, 0.0}, 0.1);
  EXPECT_TRUE(belief.is_disbelieved);
  belief = with_wheels(belief, {0.5, 0.0, 0.0}, 0.1);
  EXPECT_FALSE(belief.is_disbelieved);
  EXPECT_EQ(belief.log_odds, 0.0);
}

TEST(OdometryBelief, TakesStandingThatScansConfirmForNoEvidence) {
  const geometry::UncertainPose2 still{{0.0, 0.0, 0.0}, 1e-5 * geometry::Matrix3::Identity()};
  const OdometryComparison stands{
      .by_wheels = {}, .as_believed = {}, .by_scans = still, .duration_s = 0.4};
  OdometryBelief belief;
  const double before = belief.log_odds;
  for (int i = 0; i < 10; ++i) belief = compared(belief, stands);
  EXPECT_EQ(belief.log_odds, before);
  OdometryComparison moves = stands;
  moves.by_scans->pose.x_m = 0.3;
  EXPECT_FALSE(both_stand(moves));
  EXPECT_LT(compared(belief, moves).log_odds, before);
}

TEST(WheelFactorEstimator, LearnsNothingFromWheelsThatAreFrozen) {
  WheelFactorEstimator estimator;
  for (int i = 0; i < 50; ++i) estimator.observe({}, {0.5, 0.0, -0.01}, 0.1);
  EXPECT_EQ(estimator.factors().turn_bias_radps, 0.0);
  EXPECT_EQ(estimator.steps(), 0);
}

TEST(OdometryComparison, ConfirmsOnlyWhereScansTellTheWay) {
  const OdometryComparison agrees{
      .by_wheels = {1.0, 0.0, 0.0},
      .as_believed = {1.0, 0.0, 0.0},
      .by_scans = UncertainPose2{{1.0, 0.0, 0.0}, diagonal(1e-4, 1e-4, 1e-6)},
      .duration_s = 1.0};
  EXPECT_TRUE(confirms(agrees));
  OdometryComparison along_a_wall = agrees;
  along_a_wall.by_scans->covariance(0, 0) = 1.0;
  EXPECT_FALSE(confirms(along_a_wall));
  OdometryComparison slips = agrees;
  slips.as_believed.x_m = 1.5;
  EXPECT_FALSE(confirms(slips));
  OdometryComparison unmatched = agrees;
  unmatched.by_scans.reset();
  EXPECT_FALSE(confirms(unmatched));
}

TEST(OdometryComparison, SaysHowFarOffFrozenWheelsMayHaveLeftThePose) {
  const OdometryComparison frozen{
      .by_wheels = {},
      .as_believed = {},
      .by_scans = UncertainPose2{{0.5, 0.0, 0.0}, diagonal(1e-4, 1e-4, 1e-6)},
      .duration_s = 1.0};
  const Eigen::Vector2d off_m = unnoticed_error_m(frozen, 4.0);
  EXPECT_NEAR(off_m.x(), 2.0, 1e-9);
  EXPECT_NEAR(off_m.y(), 0.0, 1e-9);
  OdometryComparison unmatched = frozen;
  unmatched.by_scans.reset();
  EXPECT_EQ(unnoticed_error_m(unmatched, 4.0), Eigen::Vector2d(0.0, 0.0));
}

}  // namespace
}  // namespace slammot::sensing
