#include "common/filters/imm.hpp"

#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "common/filters/kalman.hpp"
#include "tests/support/maneuvers.hpp"
#include "tests/support/matchers.hpp"

namespace slammot::filters {
namespace {

using slammot::testing::accelerating;
using slammot::testing::cruising;
using slammot::testing::kManeuverPeriodS;
using slammot::testing::MatrixNear;
using slammot::testing::turning;
using slammot::testing::velocity_and_acceleration;

struct Sample {
  Vector6 truth;
  MotionState estimate;
  std::array<double, kMaxModels> probability;
  double nis;
};

/// Tracks a simulated object and returns what happened at every scan.
std::vector<Sample> simulate(const testing::Maneuver& truth_at, int scans, unsigned seed) {
  const ModelSet set = velocity_and_acceleration();
  MotionState start;
  start.mean = truth_at(0.0);
  start.covariance = 0.01 * Matrix6::Identity();
  ImmState state = imm_start(set, start);
  std::vector<Sample> samples;
  for (const Eigen::Vector2d& z : testing::measured(truth_at, scans, seed)) {
    const Vector6 truth = truth_at(static_cast<double>(samples.size() + 1) * kManeuverPeriodS);
    const ImmState predicted = imm_predict(set, state, kManeuverPeriodS);
    state = imm_update(set, predicted, z, testing::maneuver_noise_m2()).posterior;
    samples.push_back({truth, imm_combine(set, state), state.probability,
                       imm_innovation(set, predicted, z, testing::maneuver_noise_m2()).nis});
  }
  return samples;
}

double mean_over(const std::vector<Sample>& samples, std::size_t from,
                 const std::function<double(const Sample&)>& value) {
  double sum = 0.0;
  for (std::size_t i = from; i < samples.size(); ++i) sum += value(samples[i]);
  return sum / static_cast<double>(samples.size() - from);
}

double velocity_error_mps(const Sample& sample) {
  return (sample.truth.segment<2>(2) - sample.estimate.mean.segment<2>(2)).norm();
}

TEST(Imm, TakesAStepOfThePlaceThatIsFollowedForNoMotionWhereItIsToldOfIt) {
  const ModelSet set = velocity_and_acceleration();
  MotionState start;
  start.mean << 0.0, 0.0, 5.0, 0.0, 0.0, 0.0;
  start.covariance.diagonal() << 0.01, 0.01, 0.1, 0.1, 0.1, 0.1;
  const Eigen::Matrix2d R = 0.01 * Eigen::Matrix2d::Identity();
  const auto velocity_after_a_step_mps = [&](const Eigen::Matrix2d& told_m2) {
    ImmState state = imm_start(set, start);
    for (int scan = 1; scan <= 12; ++scan) {
      const double step_m = scan > 10 ? 2.0 : 0.0;
      state = imm_predict(set, state, kManeuverPeriodS);
      if (scan == 11) imm_loosen(set, state, told_m2);
      state = imm_update(set, state, {5.0 * scan * kManeuverPeriodS + step_m, 0.0}, R).posterior;
    }
    return imm_combine(set, state).mean[2];
  };
  EXPECT_NEAR(velocity_after_a_step_mps(4.0 * Eigen::Matrix2d::Identity()), 5.0, 0.3);
  EXPECT_GT(std::abs(velocity_after_a_step_mps(Eigen::Matrix2d::Zero()) - 5.0), 0.5);
}

TEST(Imm, AddsAccelerationNoiseForEveryMixture) {
  MotionState start;
  start.mean << 0.0, 0.0, 5.0, 0.0, 0.0, 0.0;
  start.covariance.setIdentity();
  const Eigen::Matrix2d density = Eigen::Vector2d(3.0, 0.0).asDiagonal();
  for (const Mixture mixture : {Mixture::kImm, Mixture::kGpb1, Mixture::kGpb2}) {
    ModelSet set = velocity_and_acceleration();
    set.mixture = mixture;
    const ImmState predicted = imm_predict(set, imm_start(set, start), kManeuverPeriodS);
    ImmState noisy = predicted;
    imm_add_acceleration_noise(set, noisy, density, 2.0);
    const Matrix6 added =
        imm_combine(set, noisy).covariance - imm_combine(set, predicted).covariance;
    EXPECT_NEAR(added(0, 0), 8.0, 1e-9);  // 3 t^3 / 3, 3 t^2 / 2, 3 t: Bar-Shalom 2001, 6.2.2
    EXPECT_NEAR(added(0, 2), 6.0, 1e-9);
    EXPECT_NEAR(added(2, 0), 6.0, 1e-9);
    EXPECT_NEAR(added(2, 2), 6.0, 1e-9);
    EXPECT_NEAR(added(1, 1) + added(3, 3), 0.0, 1e-9);
    const Eigen::Matrix2d R = Eigen::Matrix2d::Identity();
    const Eigen::Vector2d far_m(4.0, 0.0);
    EXPECT_GT(imm_combine(set, imm_update(set, noisy, far_m, R).posterior).mean.x(),
              imm_combine(set, imm_update(set, predicted, far_m, R).posterior).mean.x() + 0.5);
  }
}

TEST(Imm, TakesAMeasuredComponentOfTheVelocityAsAKalmanFilterDoes) {
  const ModelSet set = velocity_and_acceleration();
  MotionState start;
  start.mean << 1.0, 2.0, 3.0, 4.0, 0.5, -0.5;
  start.covariance = 0.5 * Matrix6::Identity() + 0.1 * Matrix6::Ones();
  ImmState state = imm_start(set, start);
  state.probability = {0.3, 0.7, 0.0};
  const Eigen::Vector2d direction{0.6, -0.8};
  constexpr double kVariance = 0.04;
  const ImmState posterior = imm_update_speed(set, state, direction, 0.2, kVariance);
  Vector6 h = Vector6::Zero();
  h.segment<2>(2) = direction;
  const Matrix6 information = start.covariance.inverse() + h * h.transpose() / kVariance;
  const Vector6 mean =
      information.inverse() * (start.covariance.inverse() * start.mean + h * 0.2 / kVariance);
  for (std::size_t mode = 0; mode < set.size; ++mode) {
    EXPECT_THAT(posterior.modes[mode].covariance, MatrixNear(Matrix6(information.inverse()), 1e-9));
    EXPECT_THAT(posterior.modes[mode].mean, MatrixNear(mean, 1e-9));
  }
  EXPECT_EQ(posterior.probability, state.probability);
}

TEST(Imm, HoldsAnAcceleratingObjectToAccelerate) {  // Wang 2004, Figures 4.2 and 4.3
  const auto samples = simulate(accelerating, 60, 1);
  EXPECT_GT(mean_over(samples, 20, [](const Sample& s) { return s.probability[1]; }), 0.85);
  EXPECT_LT(mean_over(samples, 20, velocity_error_mps), 0.6);
}

TEST(Imm, HoldsACruisingObjectToCruise) {  // Figures 4.4 and 4.5
  const auto samples = simulate(cruising, 100, 2);
  EXPECT_GT(mean_over(samples, 20, [](const Sample& s) { return s.probability[0]; }), 0.7);
  EXPECT_LT(mean_over(samples, 20, velocity_error_mps), 0.2);
}

TEST(Imm, FollowsATurnThatNeitherModelDescribes) {  // Figures 4.6 and 4.7
  const auto samples = simulate(turning, 100, 3);
  EXPECT_LT(mean_over(samples, 20,
                      [](const Sample& s) { return (s.truth - s.estimate.mean).head<2>().norm(); }),
            0.13);
  EXPECT_LT(mean_over(samples, 20, velocity_error_mps), 0.7);
}

TEST(Imm, HasInnovationsAsLargeAsItSays) {
  double nis = 0.0;
  constexpr int kRuns = 40;
  for (unsigned run = 0; run < kRuns; ++run)
    nis += mean_over(simulate(cruising, 60, 100 + run), 10, [](const Sample& s) { return s.nis; }) /
           kRuns;
  EXPECT_GT(nis, 1.3);   // conservative while the models are mixed,
  EXPECT_LT(nis, 2.06);  // but never over-confident: upper end of the 95 % band of 2000 scans
}

TEST(Imm, IsAKalmanFilterWhenThereIsOneModel) {
  ModelSet set;
  set.models[0] = {MotionKind::kConstantAcceleration, 0.5, 0.0};
  set.size = 1;
  MotionState start;
  start.covariance = Matrix6::Identity();
  const Eigen::Vector2d z{0.4, -0.2};
  const Eigen::Matrix2d R = 0.04 * Eigen::Matrix2d::Identity();
  const ImmState predicted = imm_predict(set, imm_start(set, start), 0.3);
  const ImmUpdate update = imm_update(set, predicted, z, R);
  Eigen::Matrix<double, 2, 6> H = Eigen::Matrix<double, 2, 6>::Zero();
  H(0, 0) = H(1, 1) = 1.0;
  const auto expected = kalman_update<6, 2>(predict(set.models[0], start, 0.3), z, H, R);
  const MotionState combined = imm_combine(set, update.posterior);
  EXPECT_THAT(combined.mean, MatrixNear(expected.posterior.mean, 1e-12));
  EXPECT_THAT(combined.covariance, MatrixNear(expected.posterior.covariance, 1e-12));
  EXPECT_NEAR(update.log_likelihood, expected.innovation.log_likelihood, 1e-12);
  EXPECT_NEAR(imm_innovation(set, predicted, z, R).nis, expected.innovation.nis, 1e-9);
}

TEST(Imm, MovesWithTheWorld) {
  const ModelSet set = velocity_and_acceleration();
  MotionState start;
  start.covariance = Matrix6::Identity();
  const Eigen::Vector2d shift{100.0, -40.0};
  MotionState moved_start = start;
  moved_start.mean.head<2>() += shift;
  const Eigen::Matrix2d R = 0.04 * Eigen::Matrix2d::Identity();
  ImmUpdate here = imm_update(set, imm_predict(set, imm_start(set, start), 0.2), {0.5, 0.1}, R);
  const ImmUpdate there = imm_update(set, imm_predict(set, imm_start(set, moved_start), 0.2),
                                     Eigen::Vector2d(0.5, 0.1) + shift, R);
  imm_shift(set, here.posterior, shift);
  EXPECT_THAT(imm_combine(set, here.posterior).mean,
              MatrixNear(imm_combine(set, there.posterior).mean, 1e-9));
  EXPECT_NEAR(here.posterior.probability[0], there.posterior.probability[0], 1e-12);
}

TEST(Imm, TakesUpAModelThatBecomesPossibleAndLetsGoOfOneThatDoesNot) {
  ModelSet three = velocity_and_acceleration();
  three.models[three.size++] = {MotionKind::kCoordinatedTurn, 0.5, 0.0};
  const ModelSet two = velocity_and_acceleration();
  ImmState state = imm_start(two, testing::start_of(turning));
  const auto follow = [&](const ModelSet& set, int from, int until) {
    const auto positions_m = testing::measured(turning, until, 4);
    for (int scan = from; scan < until; ++scan)
      state = imm_update(set, imm_predict(set, state, kManeuverPeriodS),
                         positions_m[static_cast<std::size_t>(scan)], testing::maneuver_noise_m2())
                  .posterior;
  };
  follow(two, 0, 20);
  EXPECT_EQ(state.probability[2], 0.0);
  follow(three, 20, 60);
  EXPECT_GT(state.probability[2], 0.5);
  const MotionState with_turn = imm_combine(three, state);
  state = imm_predict(two, state, 0.0);
  EXPECT_EQ(state.probability[2], 0.0);
  EXPECT_NEAR(state.probability[0] + state.probability[1], 1.0, 1e-12);
  EXPECT_THAT(imm_combine(two, state).mean.head<4>(),
              MatrixNear(with_turn.mean.head<4>(), 1e-9));  // nothing is lost
}

TEST(Imm, SwitchesAsMuchInOneLongStepAsInManyShortOnes) {
  const ModelSet set = velocity_and_acceleration();
  MotionState start;
  start.covariance = Matrix6::Identity();
  ImmState once = imm_start(set, start);
  once.probability = {1.0, 0.0, 0.0};
  ImmState often = once;
  once = imm_predict(set, once, 0.01);
  for (int i = 0; i < 10; ++i) often = imm_predict(set, often, 0.001);
  EXPECT_NEAR(once.probability[1], often.probability[1], 1e-4);
}

}  // namespace
}  // namespace slammot::filters
