#include "common/geometry/pose2.hpp"

#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"

namespace slammot::geometry {
namespace {

using slammot::testing::PoseNear;

const Pose2 kA{1.0, -2.0, 0.7};
const Pose2 kB{-4.0, 0.5, -3.0};
const Pose2 kC{0.3, 7.0, 2.5};

TEST(Pose2, CompoundsAssociatively) {
  EXPECT_THAT((kA * kB) * kC, PoseNear(kA * (kB * kC), 1e-12));
}

TEST(Pose2, HasIdentityOnBothSides) {
  EXPECT_THAT(kA * Pose2::identity(), PoseNear(kA, 1e-15));
  EXPECT_THAT(Pose2::identity() * kA, PoseNear(kA, 1e-15));
}

TEST(Pose2, InverseCancelsOnBothSides) {
  EXPECT_THAT(inverse(kB) * kB, PoseNear(Pose2::identity(), 1e-12));
  EXPECT_THAT(kB * inverse(kB), PoseNear(Pose2::identity(), 1e-12));
}

TEST(Pose2, MovesPointsAsItCompounds) {
  const Vector2 point_in_c{3.0, -1.0};
  const Vector2 one_by_one = kA * (kB * point_in_c);
  EXPECT_NEAR(((kA * kB) * point_in_c - one_by_one).norm(), 0.0, 1e-12);
}

TEST(Pose2, DiffersTheShortWayRound) {
  const Eigen::Vector3d ahead = difference({1.0, -2.0, 3.1}, {0.5, 1.0, -3.1});
  EXPECT_NEAR((ahead - Eigen::Vector3d(0.5, -3.0, 6.2 - 2.0 * std::numbers::pi)).norm(), 0.0,
              1e-12);
  EXPECT_EQ(difference(kA, kA), Eigen::Vector3d::Zero());
  EXPECT_EQ(difference(kA, kB), -difference(kB, kA));
}

TEST(WrapAngle, ReturnsTheAngleInTheHalfOpenInterval) {
  constexpr double kPi = std::numbers::pi;
  EXPECT_DOUBLE_EQ(wrap_angle(-kPi), kPi);
  EXPECT_DOUBLE_EQ(wrap_angle(kPi), kPi);
  EXPECT_NEAR(wrap_angle(7.0), 7.0 - 2.0 * kPi, 1e-15);
  EXPECT_DOUBLE_EQ(wrap_angle(-0.25), -0.25);
}

TEST(Interpolate, TakesTheShortWayAcrossTheCut) {
  const Pose2 from{0.0, 0.0, 3.1};
  const Pose2 to{2.0, 4.0, -3.1};
  EXPECT_THAT(interpolate(from, to, 0.5), PoseNear(Pose2{1.0, 2.0, std::numbers::pi}, 1e-12));
}

}  // namespace
}  // namespace slammot::geometry
