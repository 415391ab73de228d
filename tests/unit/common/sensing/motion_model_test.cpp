#include "common/sensing/motion_model.hpp"

#include <cmath>
#include <random>

#include <Eigen/Eigenvalues>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"
#include "tests/support/synthetic_world.hpp"

namespace slammot::sensing {
namespace {

using geometry::Pose2;
using slammot::testing::arc;
using slammot::testing::PoseNear;
using slammot::testing::step_by_wheels;
using slammot::testing::WheelErrors;

constexpr double kStep_s = 0.1;
const MotionModelConfig kConfig;

/// A drive of many steps along arcs that turn both ways, by wheels with errors and by a match with noise.
MotionCalibration after_driving(int steps, const WheelErrors& errors, const MotionModelConfig& config, double speed_mps = 8.0) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 1.0);
  MotionCalibration calibration = uncalibrated(config);
  for (int i = 0; i < steps; ++i) {
    const Pose2 truth = arc({}, speed_mps, 0.3 * std::sin(0.05 * i))(kStep_s);
    const Pose2 by_match = truth * Pose2{0.005 * noise(random), 0.005 * noise(random), 0.001 * noise(random)};
    calibration = calibrated(calibration, step_by_wheels(truth, kStep_s, errors), by_match, kStep_s, config);
  }
  return calibration;
}

TEST(MotionCalibration, BeginsAtThePrior) {
  const MotionCalibration calibration = uncalibrated(kConfig);
  EXPECT_EQ(calibration.scale(), 1.0);
  EXPECT_DOUBLE_EQ(std::sqrt(calibration.covariance(0, 0)), kConfig.scale_prior);
  EXPECT_DOUBLE_EQ(std::sqrt(calibration.covariance(1, 1)), kConfig.heading_rate_bias_prior_radps);
  EXPECT_DOUBLE_EQ(std::sqrt(calibration.covariance(2, 2)), kConfig.heading_per_metre_bias_prior);
}

TEST(MotionCalibration, LearnsAScaleThatIsOnePercentOff) {
  for (const double scale : {0.99, 1.01}) EXPECT_NEAR(after_driving(300, {.scale = scale}, kConfig).scale(), scale, 0.001);
}

TEST(MotionCalibration, LearnsTheTurnThatABiasedGyroMisses) {
  const double bias_radps = 0.003;
  const MotionCalibration calibration = after_driving(600, {.heading_rate_bias_radps = bias_radps}, kConfig, 2.0);
  // At one speed a bias by time and one by distance are the same thing: only their sum can be known.
  EXPECT_NEAR(calibration.state.y() + 2.0 * calibration.state.z(), bias_radps, 0.0012);
}

TEST(MotionCalibration, TellsABiasByTimeFromOneByDistanceWhenTheSpeedChanges) {
  const MotionModelConfig config{.heading_rate_bias_prior_radps = 0.02};
  MotionCalibration calibration = uncalibrated(config);
  for (int i = 0; i < 2000; ++i) {
    const Pose2 truth = arc({}, i % 100 < 50 ? 0.5 : 10.0, 0.0)(kStep_s);
    calibration = calibrated(calibration, step_by_wheels(truth, kStep_s, {.heading_rate_bias_radps = 0.01}), truth, kStep_s, config);
  }
  EXPECT_NEAR(calibration.state.y(), 0.01, 0.002);
  EXPECT_NEAR(calibration.state.z(), 0.0, 0.0005);
}

TEST(MotionCalibration, BecomesSurerWithEveryStepAndStaysACovariance) {
  MotionCalibration calibration = uncalibrated(kConfig);
  for (int i = 0; i < 1000; ++i) {
    const Pose2 truth = arc({}, 5.0, 0.2)(kStep_s);
    const MotionCalibration next = calibrated(calibration, truth, truth, kStep_s, kConfig);
    for (int k = 0; k < 3; ++k) EXPECT_LE(next.covariance(k, k), calibration.covariance(k, k) * (1.0 + 1e-12));
    calibration = next;
  }
  EXPECT_NEAR((calibration.covariance - calibration.covariance.transpose()).norm(), 0.0, 1e-15);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(calibration.covariance).eigenvalues().minCoeff(), 0.0);
}

TEST(MotionCalibration, IsAsUncertainAsItIsWrong) {
  std::mt19937 random(17);
  std::normal_distribution<double> noise(0.0, 1.0);
  double squared_error_in_sigmas = 0.0;
  constexpr int kRuns = 200;
  for (int run = 0; run < kRuns; ++run) {
    const double scale = 1.0 + kConfig.scale_prior * noise(random);
    MotionCalibration calibration = uncalibrated(kConfig);
    for (int i = 0; i < 50; ++i) {
      const Pose2 by_wheels{0.5, 0.0, 0.0};
      const double sigma_m = std::hypot(kConfig.match_position_noise_m, kConfig.position_noise_per_m * 0.5);
      const Pose2 by_match{scale * 0.5 + sigma_m * noise(random), 0.0, 0.0};
      calibration = calibrated(calibration, by_wheels, by_match, kStep_s, kConfig);
    }
    squared_error_in_sigmas += std::pow(calibration.scale() - scale, 2) / calibration.covariance(0, 0);
  }
  // Chi-square with kRuns degrees of freedom: mean 1, sigma sqrt(2 / kRuns) = 0.1. Outliers are left out, so a little wider.
  EXPECT_NEAR(squared_error_in_sigmas / kRuns, 1.0, 0.35);
}

TEST(MotionCalibration, LearnsNothingFromAVehicleThatStands) {
  const MotionCalibration before = uncalibrated(kConfig);
  const MotionCalibration after = calibrated(before, {0.001, 0.0, 0.0}, {0.004, 0.0, 0.003}, kStep_s, kConfig);
  EXPECT_EQ(after.state, before.state);
  EXPECT_EQ(after.covariance, before.covariance);
}

TEST(MotionCalibration, LearnsNothingFromAWrongMatch) {
  const MotionCalibration before = after_driving(100, {.scale = 1.01}, kConfig);
  const MotionCalibration after = calibrated(before, {0.8, 0.0, 0.0}, {1.6, 0.0, 0.7}, kStep_s, kConfig);
  EXPECT_EQ(after.state, before.state);
}

TEST(PredictStep, UndoesTheErrorsThatItKnows) {
  const Pose2 truth = arc({}, 10.0, 0.4)(kStep_s);
  MotionCalibration calibration;
  calibration.state = {0.013, 0.02, 0.0};
  const Pose2 by_wheels = step_by_wheels(truth, kStep_s, {.scale = 1.013, .heading_rate_bias_radps = 0.02});
  EXPECT_THAT(predict_step(by_wheels, kStep_s, calibration, kConfig).pose, PoseNear(truth, 1e-12));
}

TEST(PredictStep, WithoutKnownErrorsIsWhatTheWheelsSay) {
  const Pose2 by_wheels{0.7, -0.02, 0.05};
  EXPECT_THAT(predict_step(by_wheels, kStep_s, uncalibrated(kConfig), kConfig).pose, PoseNear(by_wheels, 1e-15));
}

TEST(PredictStep, IsLessSureTheFartherItGoes) {
  const auto sigma = [](double distance_m) {
    const auto step = predict_step({distance_m, 0.0, 0.0}, kStep_s, uncalibrated(kConfig), kConfig);
    return Eigen::Vector2d(std::sqrt(step.covariance(0, 0)), std::sqrt(step.covariance(2, 2)));
  };
  EXPECT_GE(sigma(0.0).x(), kConfig.position_noise_m);
  EXPECT_GT(sigma(1.0).x(), sigma(0.5).x());
  EXPECT_GT(sigma(1.0).y(), sigma(0.5).y());
}

TEST(PredictStep, IsSurerOnceItIsCalibrated) {
  const Pose2 by_wheels{0.8, 0.0, 0.0};
  const auto before = predict_step(by_wheels, kStep_s, uncalibrated(kConfig), kConfig);
  const auto after = predict_step(by_wheels, kStep_s, after_driving(300, {}, kConfig), kConfig);
  EXPECT_LT(after.covariance(0, 0), before.covariance(0, 0));
  EXPECT_LT(after.covariance(2, 2), before.covariance(2, 2));
}

TEST(PredictStepAtVelocity, FollowsTheArc) {
  for (const double yaw_rate_radps : {0.0, 0.3, -0.8}) {
    const auto step = predict_step_at_velocity(5.0, yaw_rate_radps, kStep_s, kConfig);
    EXPECT_THAT(step.pose, PoseNear(arc({}, 5.0, yaw_rate_radps)(kStep_s), 2e-4));
  }
}

TEST(PredictStepAtVelocity, AllowsForTheAccelerationOfTheWholeStep) {
  const auto sigma_m = [](double duration_s) {
    return std::sqrt(predict_step_at_velocity(5.0, 0.0, duration_s, kConfig).covariance(0, 0));
  };
  EXPECT_NEAR(sigma_m(2.0), kConfig.position_noise_m + 0.5 * kConfig.standstill_acceleration_mps2 * 4.0, 1e-12);
  EXPECT_LT(sigma_m(0.1), 0.03);
}

}  // namespace
}  // namespace slammot::sensing
