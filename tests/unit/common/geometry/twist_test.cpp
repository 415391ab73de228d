#include "common/geometry/twist.hpp"

#include <numbers>

#include <gtest/gtest.h>

#include "common/geometry/displacement.hpp"
#include "tests/support/matchers.hpp"

namespace slammot::geometry {
namespace {

using slammot::testing::PoseNear;

const Pose2 kPoses[] = {{}, {1.0, -2.0, 0.0}, {-3.0, 4.0, 2.5}, {30.0, 20.0, -1.2}};
const Eigen::Vector3d kTwists[] = {
    {0.0, 0.0, 0.0}, {1.0, 2.0, 1e-7}, {1.0, 2.0, -0.4}, {-5.0, 0.5, 2.9}};

TEST(Twist, IsTheLogarithmOfItsExponential) {
  for (const Eigen::Vector3d& twist : kTwists)
    EXPECT_TRUE(logarithm(exponential(twist)).isApprox(twist, 1e-9)) << twist.transpose();
}

TEST(Twist, MovesAlongAnArc) {
  // A quarter of a circle with a radius of 2 m.
  EXPECT_THAT(exponential({std::numbers::pi, 0.0, std::numbers::pi / 2}),
              PoseNear(Pose2{2.0, 2.0, std::numbers::pi / 2}, 1e-12));
}

TEST(Twist, HasNoStepWhereTheFirstOrderEnds) {
  for (const double angle_rad : {1.9e-8, 2.1e-8, 1e-6, 1e-4}) {
    const Eigen::Vector3d twist(1.0, 2.0, angle_rad);
    EXPECT_THAT(
        exponential(twist),
        PoseNear(Pose2{1.0 - angle_rad, 2.0 + 0.5 * angle_rad, angle_rad}, angle_rad * angle_rad));
    EXPECT_TRUE(logarithm(exponential(twist)).isApprox(twist, 1e-14)) << angle_rad;
  }
}

TEST(Twist, IsCarriedToAnotherFrameByTheAdjoint) {
  for (const Pose2& pose : kPoses) {
    for (const Eigen::Vector3d& twist : kTwists) {
      EXPECT_THAT(pose * exponential(twist),
                  PoseNear(exponential(adjoint(pose) * twist) * pose, 1e-9));
    }
  }
}

TEST(Twist, ChangesThePoseAsItsDerivativesSay) {
  constexpr double kStep = 1e-6;
  for (const Pose2& pose : kPoses) {
    const Matrix3 by_change = twist_by_change(pose);
    const Matrix3 by_twist = change_by_twist(pose);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(i);
      const Eigen::Vector3d change = difference(exponential(step) * pose, pose) / kStep;
      EXPECT_TRUE(by_twist.col(i).isApprox(change, 1e-4)) << change.transpose();
      const Eigen::Vector3d twist = logarithm(displaced(pose, step) * inverse(pose)) / kStep;
      EXPECT_TRUE(by_change.col(i).isApprox(twist, 1e-4)) << twist.transpose();
    }
  }
}

}  // namespace
}  // namespace slammot::geometry
