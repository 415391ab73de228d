#include "common/geometry/unscented.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "tests/support/matchers.hpp"
#include "tests/support/uncertain_poses.hpp"

namespace slammot::geometry {
namespace {

using slammot::testing::MatrixNear;
using slammot::testing::PoseNear;

const Pose2 kFirst{3.0, -1.0, 0.8};
const Pose2 kSecond{10.0, 2.0, -1.9};

Pose2 chained(const Pose2& a_from_b, const Pose2& b_from_c) { return a_from_b * b_from_c; }
Pose2 between(const Pose2& a_from_b, const Pose2& a_from_c) { return inverse(a_from_b) * a_from_c; }

TEST(Unscented, AgreesWithTheLinearFormsWhereErrorsAreSmall) {
  const auto poses = slammot::testing::correlated_poses(kFirst, kSecond, 1e-3, 1e-4);
  const auto expect_same = [](const UncertainPose2& unscented, const UncertainPose2& linear) {
    EXPECT_THAT(unscented.pose, PoseNear(linear.pose, 1e-6));
    EXPECT_THAT(unscented.covariance,
                MatrixNear(linear.covariance, 1e-5 * linear.covariance.trace()));
  };
  expect_same(unscented::compound(poses.first, poses.second, poses.cross),
              compound(poses.first, poses.second, poses.cross));
  expect_same(unscented::tail_to_tail(poses.first, poses.second, poses.cross),
              tail_to_tail(poses.first, poses.second, poses.cross));
  expect_same(unscented::inverse(poses.first), inverse(poses.first));
}

TEST(Unscented, AgreesWithMonteCarloWhereTheHeadingIsUnsure) {
  const auto poses = slammot::testing::correlated_poses(kFirst, kSecond, 0.3, 0.3);
  const auto expect_drawn = [&](const UncertainPose2& unscented,
                                const slammot::testing::OfTwoPoses& operation) {
    const UncertainPose2 drawn = slammot::testing::by_monte_carlo(poses, operation, 100000, 3);
    EXPECT_THAT(unscented.pose, PoseNear(drawn.pose, 0.03));
    EXPECT_THAT(unscented.covariance,
                MatrixNear(drawn.covariance, 0.03 * drawn.covariance.trace()));
  };
  expect_drawn(unscented::compound(poses.first, poses.second, poses.cross), chained);
  expect_drawn(unscented::tail_to_tail(poses.first, poses.second, poses.cross), between);
  expect_drawn(unscented::inverse(poses.first),
               [](const Pose2& ab, const Pose2&) { return inverse(ab); });
}

TEST(Unscented, IsNearerThanTheLinearFormsWhereTheHeadingIsUnsure) {
  // A lever of 10 m and half a radian: what it carries lies on an arc, shorter in the mean and
  // thick along the lever.
  slammot::testing::CorrelatedPoses poses;
  poses.first.covariance(2, 2) = 0.5 * 0.5;
  poses.second.pose = {10.0, 0.0, 0.0};
  const UncertainPose2 linear = compound(poses.first, poses.second);
  const UncertainPose2 unscented = unscented::compound(poses.first, poses.second);
  const double mean_x_m = 10.0 * std::exp(-0.125);
  const double variance_y_m2 = 50.0 * (1.0 - std::exp(-0.5));
  EXPECT_NEAR(unscented.pose.x_m, mean_x_m, 0.01);
  EXPECT_NEAR(unscented.covariance(1, 1), variance_y_m2, 0.5);
  EXPECT_NEAR(unscented.covariance(0, 0), 50.0 * (1.0 + std::exp(-0.5)) - mean_x_m * mean_x_m, 0.5);
  EXPECT_GT(linear.pose.x_m - mean_x_m, 1.1);
  EXPECT_GT(linear.covariance(1, 1) - variance_y_m2, 5.0);
  EXPECT_EQ(linear.covariance(0, 0), 0.0);
}

/// Difference of two Gaussians in sigmas of the second: of the means, and of the standard
/// deviations along the directions in which they differ most.
struct Difference {
  double in_mean = 0.0;
  double in_sigma = 0.0;
};

Difference position_difference(const UncertainPose2& one, const UncertainPose2& drawn) {
  const Eigen::Matrix2d P = drawn.covariance.topLeftCorner<2, 2>();
  const Eigen::Matrix2d root = P.llt().matrixL();
  const Vector2 away = root.triangularView<Eigen::Lower>().solve(one.pose.translation_m() -
                                                                 drawn.pose.translation_m());
  const Eigen::Matrix2d half =
      root.triangularView<Eigen::Lower>().solve(one.covariance.topLeftCorner<2, 2>());
  const Eigen::Matrix2d white =
      root.triangularView<Eigen::Lower>().solve(half.transpose()).transpose();
  const Eigen::Vector2d ratio =
      white.selfadjointView<Eigen::Lower>().eigenvalues().cwiseSqrt().array() - 1.0;
  return {away.norm(), ratio.cwiseAbs().maxCoeff()};
}

TEST(CompoundAsNeeded, IsNearMonteCarloHoweverUnsureTheHeadingAndLongTheLever) {
  int linear = 0;
  int unscented = 0;
  for (const double sigma_rad : {0.01, 0.05, 0.1, 0.2, 0.3, 0.5}) {
    for (const double lever_m : {1.0, 10.0, 100.0}) {
      const auto poses =
          slammot::testing::correlated_poses(kFirst, {lever_m, 0.2 * lever_m, 0.4}, 0.3, sigma_rad);
      const UncertainPose2 drawn = slammot::testing::by_monte_carlo(poses, chained, 100000, 3);
      const Difference difference = position_difference(
          unscented::compound_as_needed(poses.first, poses.second, poses.cross), drawn);
      EXPECT_LT(difference.in_mean, 0.25) << sigma_rad << " rad, " << lever_m << " m";
      EXPECT_LT(difference.in_sigma, 0.12) << sigma_rad << " rad, " << lever_m << " m";
      const bool is_linear =
          unscented::linearization_error(poses.first, poses.second, poses.cross) <=
          unscented::kLargestLinearizationError;
      (is_linear ? linear : unscented) += 1;
    }
  }
  EXPECT_GT(linear, 5);
  EXPECT_GT(unscented, 5);
}

TEST(CompoundAsNeeded, IsUnscentedWhereTheLinearFormIsFarFromMonteCarlo) {
  for (const double sigma_rad : {0.1, 0.2, 0.3, 0.5}) {
    const auto poses =
        slammot::testing::correlated_poses(kFirst, {100.0, 20.0, 0.4}, 0.3, sigma_rad);
    const UncertainPose2 drawn = slammot::testing::by_monte_carlo(poses, chained, 100000, 3);
    const Difference of_linear =
        position_difference(compound(poses.first, poses.second, poses.cross), drawn);
    EXPECT_GT(std::max(of_linear.in_mean, of_linear.in_sigma), 0.25) << sigma_rad;
    EXPECT_GT(unscented::linearization_error(poses.first, poses.second, poses.cross),
              unscented::kLargestLinearizationError);
  }
}

TEST(CompoundAsNeeded, IsTheLinearFormToTheLastBitWhereThatSuffices) {
  const auto poses = slammot::testing::correlated_poses(kFirst, kSecond, 0.3, 0.02);
  const UncertainPose2 linear = compound(poses.first, poses.second, poses.cross);
  const UncertainPose2 chosen =
      unscented::compound_as_needed(poses.first, poses.second, poses.cross);
  EXPECT_EQ(chosen.covariance, linear.covariance);
  EXPECT_EQ(chosen.pose.x_m, linear.pose.x_m);
}

TEST(LinearizationError, GrowsWithTheLeverAndTheSquareOfTheHeadingsSigma) {
  UncertainPose2 first{kFirst, Eigen::Vector3d(0.04, 0.04, 0.0001).asDiagonal()};
  const auto error_m = [&](double lever_m) {
    return unscented::linearization_error(first, {{lever_m, 0.0, 0.0}, Matrix3::Zero()});
  };
  // Along the lever the sigma is 0.2 m, and the arc of 40 m bends by 2 mm.
  EXPECT_NEAR(error_m(40.0), 0.01, 1e-3);
  EXPECT_GT(error_m(80.0), error_m(40.0));
  first.covariance(2, 2) = 0.0;
  EXPECT_EQ(error_m(40.0), 0.0);
}

TEST(LinearizationError, IsInfiniteWhereTheLinearFormClaimsCertaintyAlongATurningLever) {
  UncertainPose2 first;
  first.covariance(2, 2) = 0.01;
  EXPECT_TRUE(
      std::isinf(unscented::linearization_error(first, {{10.0, 0.0, 0.0}, Matrix3::Zero()})));
}

TEST(Unscented, StaysPositiveHoweverUnsureTheHeadingIs) {
  for (const double sigma_rad : {0.1, 0.5, 1.0, 2.0, 3.0}) {
    const auto poses = slammot::testing::correlated_poses(kFirst, kSecond, 1.0, sigma_rad);
    for (const Matrix3& covariance :
         {unscented::compound(poses.first, poses.second, poses.cross).covariance,
          unscented::tail_to_tail(poses.first, poses.second, poses.cross).covariance,
          unscented::inverse(poses.first).covariance}) {
      EXPECT_GE(covariance.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0.0);
    }
  }
}

TEST(Unscented, KnowsExactlyWhatIsKnownExactly) {
  const UncertainPose2 chain =
      unscented::compound({kFirst, Matrix3::Zero()}, {kSecond, Matrix3::Zero()});
  EXPECT_THAT(chain.pose, PoseNear(kFirst * kSecond, 1e-12));
  EXPECT_TRUE(chain.covariance.isZero());
}

}  // namespace
}  // namespace slammot::geometry
