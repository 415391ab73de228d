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
