#include "common/filters/motion_models.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"

namespace slammot::filters {
namespace {

using slammot::testing::MatrixNear;

MotionState example_state() {
  MotionState state;
  state.mean << 1.0, 2.0, 8.0, -3.0, 0.6, 1.1;
  state.covariance = 0.2 * Matrix6::Identity();
  state.covariance(0, 2) = state.covariance(2, 0) = 0.05;
  return state;
}

TEST(ConstantAcceleration, GivesTheSameInOneStepAsInTwo) {
  const MotionModel model{MotionKind::kConstantAcceleration, 0.7, 0.0};
  const MotionState once = predict(model, example_state(), 0.5);
  const MotionState twice = predict(model, predict(model, example_state(), 0.2), 0.3);
  EXPECT_THAT(once.mean, MatrixNear(twice.mean, 1e-12));
  EXPECT_THAT(once.covariance, MatrixNear(twice.covariance, 1e-12));
}

TEST(ConstantVelocity, GivesTheSameInOneStepAsInTwo) {
  const MotionModel model{MotionKind::kConstantVelocity, 1.3, 0.8};
  const MotionState once = predict(model, example_state(), 0.5);
  const MotionState twice = predict(model, predict(model, example_state(), 0.2), 0.3);
  EXPECT_THAT(once.mean, MatrixNear(twice.mean, 1e-12));
  EXPECT_THAT(once.covariance, MatrixNear(twice.covariance, 1e-12));
}

TEST(ConstantVelocity, ForgetsTheAccelerationButNotThatItMayBeThere) {
  const MotionState after =
      predict({MotionKind::kConstantVelocity, 1.0, 2.0}, example_state(), 0.1);
  EXPECT_EQ(after.mean(4), 0.0);
  EXPECT_NEAR(after.covariance(4, 4), 4.0, 1e-12);
}

TEST(MotionModels, SpreadErrorsAsTheirTransitionsSay) {  // F P F' + Q, which predict does not write
                                                         // down
  constexpr double kTimeS = 0.4;
  MotionState state = example_state();
  const Vector6 skew = Vector6::LinSpaced(-0.5, 0.7);
  state.covariance += skew * skew.transpose();
  const Matrix6 F_cv = constant_velocity_transition(kTimeS);
  EXPECT_THAT(predict({MotionKind::kConstantVelocity, 1.3, 0.8}, state, kTimeS).covariance,
              MatrixNear(F_cv * state.covariance * F_cv.transpose() +
                             constant_velocity_noise(kTimeS, 1.3, 0.8),
                         1e-12));
  const Matrix6 F_ca = constant_acceleration_transition(kTimeS);
  EXPECT_THAT(predict({MotionKind::kConstantAcceleration, 0.7, 0.0}, state, kTimeS).covariance,
              MatrixNear(F_ca * state.covariance * F_ca.transpose() +
                             constant_acceleration_noise(kTimeS, 0.7),
                         1e-12));
}

TEST(CoordinatedTurn, KeepsSpeedAndClosesTheCircle) {
  Vector6 state = Vector6::Zero();
  const double speed_mps = 15.0;
  const double turn_rate_radps = 18.0 * M_PI / 180.0;  // Wang 2004, Figure 4.6
  state(2) = speed_mps;
  state(5) = speed_mps * turn_rate_radps;
  const Vector6 quarter = turned(state, M_PI / 2.0 / turn_rate_radps);
  const double radius_m = speed_mps / turn_rate_radps;
  EXPECT_NEAR(quarter(0), radius_m, 1e-9);
  EXPECT_NEAR(quarter(1), radius_m, 1e-9);
  EXPECT_NEAR(quarter(3), speed_mps, 1e-9);
  EXPECT_THAT(turned(state, 2.0 * M_PI / turn_rate_radps), MatrixNear(state, 1e-9));
}

TEST(CoordinatedTurn, GoesStraightWithoutAcceleration) {
  Vector6 state = Vector6::Zero();
  state(2) = 3.0;
  const Vector6 after = turned(state, 2.0);
  EXPECT_NEAR(after(0), 6.0, 1e-12);
  EXPECT_NEAR(after(1), 0.0, 1e-12);
}

TEST(CoordinatedTurn, SpreadsSmallErrorsAsItsLinearizationSays) {
  // Without noise the predicted covariance is J P J'. With P = u u' it is (J u)(J u)', which a
  // finite step along u gives, too.
  const MotionModel noiseless{MotionKind::kCoordinatedTurn, 0.0, 0.0};
  Vector6 straight = Vector6::Zero();
  straight(2) = 12.0;
  Vector6 turning = straight;
  turning(5) = 12.0 * 0.3;
  for (const Vector6& mean : {example_state().mean, straight, turning}) {
    for (int axis = 0; axis < 6; ++axis) {
      constexpr double kStep = 1e-3;
      const Vector6 step = kStep * Vector6::Unit(axis);
      const Vector6 spread = (turned(mean + step, 0.4) - turned(mean - step, 0.4)) / 2.0;
      const MotionState after = predict(noiseless, {mean, step * step.transpose()}, 0.4);
      EXPECT_THAT(after.covariance / (kStep * kStep),
                  MatrixNear(spread * spread.transpose() / (kStep * kStep), 1e-5))
          << axis;
    }
  }
}

TEST(MotionModels, DoNotMoveWhenNoTimePasses) {
  for (const MotionKind kind : {MotionKind::kConstantAcceleration, MotionKind::kCoordinatedTurn}) {
    const MotionState after = predict({kind, 1.0, 1.0}, example_state(), 0.0);
    EXPECT_THAT(after.mean, MatrixNear(example_state().mean, 1e-12));
    EXPECT_THAT(after.covariance, MatrixNear(example_state().covariance, 1e-9));
  }
}

}  // namespace
}  // namespace slammot::filters
