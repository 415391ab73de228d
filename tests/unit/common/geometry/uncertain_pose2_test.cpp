#include "common/geometry/uncertain_pose2.hpp"

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "tests/support/matchers.hpp"
#include "tests/support/uncertain_poses.hpp"

namespace slammot::geometry {
namespace {

using slammot::testing::MatrixNear;

Eigen::Vector3d as_vector(const Pose2& pose) { return {pose.x_m, pose.y_m, pose.heading_rad}; }
Pose2 as_pose(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Matrix3 numerical_jacobian(const std::function<Pose2(const Pose2&)>& function, const Pose2& at) {
  constexpr double kStep = 1e-6;
  Matrix3 jacobian;
  for (int column = 0; column < 3; ++column) {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(column);
    Eigen::Vector3d difference = as_vector(function(as_pose(as_vector(at) + step))) -
                                 as_vector(function(as_pose(as_vector(at) - step)));
    difference.z() = wrap_angle(difference.z());
    jacobian.col(column) = difference / (2.0 * kStep);
  }
  return jacobian;
}

Matrix3 example_covariance() {
  Matrix3 covariance;
  covariance << 0.04, 0.01, 0.001, 0.01, 0.09, -0.002, 0.001, -0.002, 0.0016;
  return covariance;
}

const Pose2 kFirst{3.0, -1.0, 0.8};
const Pose2 kSecond{5.0, 2.0, -1.9};

TEST(CompoundJacobians, AgreeWithNumericalOnes) {
  EXPECT_THAT(
      compound_jacobian_first(kFirst, kSecond),
      MatrixNear(numerical_jacobian([](const Pose2& p) { return p * kSecond; }, kFirst), 1e-8));
  EXPECT_THAT(
      compound_jacobian_second(kFirst),
      MatrixNear(numerical_jacobian([](const Pose2& p) { return kFirst * p; }, kSecond), 1e-8));
}

TEST(InverseJacobian, AgreesWithTheNumericalOne) {
  EXPECT_THAT(
      inverse_jacobian(kFirst),
      MatrixNear(numerical_jacobian([](const Pose2& p) { return inverse(p); }, kFirst), 1e-8));
}

TEST(Compound, TurnsHeadingErrorIntoLateralErrorAtTheEndOfALeverArm) {
  UncertainPose2 map_from_base;
  map_from_base.covariance(2, 2) = 0.010 * 0.010;  // one sigma 0.010 rad
  const UncertainPose2 base_from_laser{Pose2{10.0, 0.0, 0.0}, Matrix3::Zero()};
  EXPECT_NEAR(std::sqrt(compound(map_from_base, base_from_laser).covariance(1, 1)), 0.10, 1e-9);
}

TEST(Compound, AgreesWithMonteCarlo) {
  const UncertainPose2 first{kFirst, example_covariance()};
  const UncertainPose2 second{kSecond, 0.5 * example_covariance()};
  const Matrix3 root_first = first.covariance.llt().matrixL();
  const Matrix3 root_second = second.covariance.llt().matrixL();
  const UncertainPose2 predicted = compound(first, second);
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  const auto draw = [&] { return Eigen::Vector3d(normal(random), normal(random), normal(random)); };
  Matrix3 scatter = Matrix3::Zero();
  constexpr int kDraws = 40000;
  for (int i = 0; i < kDraws; ++i) {
    const Pose2 sample = as_pose(as_vector(kFirst) + root_first * draw()) *
                         as_pose(as_vector(kSecond) + root_second * draw());
    Eigen::Vector3d error = as_vector(sample) - as_vector(predicted.pose);
    error.z() = wrap_angle(error.z());
    scatter += error * error.transpose() / kDraws;
  }
  EXPECT_THAT(scatter, MatrixNear(predicted.covariance, 0.02 * predicted.covariance.trace()));
}

TEST(TailToTail, RecoversThePoseThatWasCompounded) {
  const UncertainPose2 exact_first{kFirst, Matrix3::Zero()};
  const UncertainPose2 second{kSecond, example_covariance()};
  const UncertainPose2 recovered = tail_to_tail(exact_first, compound(exact_first, second));
  EXPECT_THAT(recovered.pose, slammot::testing::PoseNear(kSecond, 1e-12));
  EXPECT_THAT(recovered.covariance, MatrixNear(second.covariance, 1e-12));
}

TEST(Compound, HoldsWhatTheErrorsOfBothPosesShare) {
  const auto poses = slammot::testing::correlated_poses(kFirst, kSecond, 0.05, 0.01);
  const UncertainPose2 drawn = slammot::testing::by_monte_carlo(
      poses, [](const Pose2& ab, const Pose2& bc) { return ab * bc; }, 40000, 7);
  const UncertainPose2 held = compound(poses.first, poses.second, poses.cross);
  EXPECT_THAT(held.covariance, MatrixNear(drawn.covariance, 0.015 * held.covariance.trace()));
  // Taken for independent they would not be near it.
  EXPECT_GT(
      (compound(poses.first, poses.second).covariance - drawn.covariance).cwiseAbs().maxCoeff(),
      0.1 * held.covariance.trace());
}

TEST(TailToTail, HoldsWhatTheErrorsOfBothPosesShare) {
  const auto poses = slammot::testing::correlated_poses(kFirst, kSecond, 0.05, 0.01);
  const UncertainPose2 drawn = slammot::testing::by_monte_carlo(
      poses, [](const Pose2& ab, const Pose2& ac) { return inverse(ab) * ac; }, 40000, 7);
  const UncertainPose2 held = tail_to_tail(poses.first, poses.second, poses.cross);
  EXPECT_THAT(held.covariance, MatrixNear(drawn.covariance, 0.015 * held.covariance.trace()));
  EXPECT_GT(
      (tail_to_tail(poses.first, poses.second).covariance - drawn.covariance).cwiseAbs().maxCoeff(),
      0.1 * held.covariance.trace());
}

TEST(TailToTail, CancelsAnErrorThatBothPosesHaveInFull) {
  // Two things seen from a frame that is itself unsure: what lies between them is as sure as the
  // step from one to the other.
  const UncertainPose2 a_from_b{kFirst, example_covariance()};
  const UncertainPose2 step{kSecond, 0.1 * example_covariance()};
  const UncertainPose2 a_from_c = compound(a_from_b, step);
  const Matrix3 cross = a_from_b.covariance * compound_jacobian_first(kFirst, kSecond).transpose();
  EXPECT_THAT(tail_to_tail(a_from_b, a_from_c, cross).covariance,
              MatrixNear(step.covariance, 1e-12));
}

}  // namespace
}  // namespace slammot::geometry
