#include "common/filters/kalman.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "common/filters/model_set.hpp"
#include "common/filters/motion_models.hpp"
#include "tests/support/matchers.hpp"

namespace slammot::filters {
namespace {

using slammot::testing::MatrixNear;
using Matrix26 = Eigen::Matrix<double, 2, 6>;

Matrix26 position_of_state() {
  Matrix26 H = Matrix26::Zero();
  H(0, 0) = H(1, 1) = 1.0;
  return H;
}

TEST(KalmanUpdate, IsTheInformationFormOfBayes) {
  Gaussian<2> prior;
  prior.mean << 1.0, -1.0;
  prior.covariance << 2.0, 0.3, 0.3, 0.5;
  const Eigen::Matrix<double, 1, 2> H{{0.4, 1.0}};
  const Eigen::Matrix<double, 1, 1> R{0.25};
  const Eigen::Matrix<double, 1, 1> z{0.7};
  const auto update = kalman_update<2, 1>(prior, z, H, R);
  const Eigen::Matrix2d information = prior.covariance.inverse() + H.transpose() * R.inverse() * H;
  const Eigen::Vector2d mean = information.inverse() * (prior.covariance.inverse() * prior.mean +
                                                        H.transpose() * R.inverse() * z);
  EXPECT_THAT(update.posterior.covariance, MatrixNear(information.inverse(), 1e-12));
  EXPECT_THAT(update.posterior.mean, MatrixNear(mean, 1e-12));
}

TEST(KalmanUpdate, ByAPositionIsTheSameToTheLastBitWithoutTheProductsWithOnesAndZeros) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 100; ++i) {
    const Matrix6 root = Matrix6::NullaryExpr([&] { return normal(random); });
    const Gaussian<6> prior{root.col(0), root * root.transpose()};
    const Eigen::Vector2d z{normal(random), normal(random)};
    const Eigen::Matrix2d R{{0.3, 0.1}, {0.1, 0.2}};
    const auto expected = kalman_update<6, 2>(prior, z, position_of_state(), R);
    const auto update = update_with_position(prior, z, R);
    EXPECT_EQ(update.posterior.mean, expected.posterior.mean);
    EXPECT_EQ(update.posterior.covariance, expected.posterior.covariance);
    EXPECT_EQ(update.innovation.log_likelihood, expected.innovation.log_likelihood);
  }
}

TEST(Innovation, GivesTheLogarithmOfTheNormalDensity) {
  const auto standard =
      innovation<1>(Eigen::Matrix<double, 1, 1>{2.0}, Eigen::Matrix<double, 1, 1>{4.0});
  EXPECT_NEAR(standard.nis, 1.0, 1e-12);
  EXPECT_NEAR(standard.log_likelihood, -0.5 - std::log(2.0) - 0.5 * std::log(2.0 * M_PI), 1e-12);
}

TEST(Kalman, IsHonestAboutAnObjectThatMovesAsItsModelSays) {
  const MotionModel model{MotionKind::kConstantAcceleration, 0.5, 0.0};
  const Eigen::Matrix2d R = 0.01 * Eigen::Matrix2d::Identity();
  std::mt19937_64 random(17);
  std::normal_distribution<double> normal;
  const auto draw = [&](const Matrix6& covariance) -> Vector6 {
    Vector6 white;
    for (double& value : white) value = normal(random);
    return covariance.llt().matrixL() * white;
  };
  constexpr int kRuns = 200;
  constexpr int kSteps = 30;
  double nees = 0.0;
  double nis = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    MotionState estimate;
    estimate.covariance = Matrix6::Identity();
    Vector6 truth = draw(estimate.covariance);
    for (int step = 0; step < kSteps; ++step) {
      const double time_s = step % 3 == 0 ? 0.1 : 0.04;  // the rate may change
      truth = constant_acceleration_transition(time_s) * truth +
              draw(constant_acceleration_noise(time_s, 0.5));
      const Eigen::Vector2d z =
          truth.head<2>() + 0.1 * Eigen::Vector2d(normal(random), normal(random));
      const auto update =
          kalman_update<6, 2>(predict(model, estimate, time_s), z, position_of_state(), R);
      estimate = update.posterior;
      nis += update.innovation.nis / (kRuns * kSteps);
    }
    const Vector6 error = truth - estimate.mean;
    nees += error.dot(estimate.covariance.llt().solve(error)) / kRuns;
  }
  // 95 % bands of chi-square means: 6 +- 1.96 sqrt(12/200); 2 +- 1.96 sqrt(4/6000).
  EXPECT_NEAR(nees, 6.0, 0.48);
  EXPECT_NEAR(nis, 2.0, 0.051);
}

}  // namespace
}  // namespace slammot::filters
