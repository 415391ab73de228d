#include "common/geometry/displacement.hpp"

#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"

namespace slammot::geometry {
namespace {

using slammot::testing::PoseNear;

const Pose2 kA{1.0, -2.0, 0.7};
const Pose2 kB{-4.0, 0.5, -3.0};

TEST(Displacement, IsTheOppositeOfADifference) {
  EXPECT_THAT(displaced(kB, difference(kA, kB)), PoseNear(kA, 1e-12));
  EXPECT_NEAR(displaced({0.0, 0.0, 3.1}, {0.0, 0.0, 0.1}).heading_rad, 3.2 - 2.0 * std::numbers::pi,
              1e-12);
}

TEST(Displacement, MovesNothingTenMetresAwayByMoreThanItsLength) {
  const Eigen::Vector3d by{0.03, 0.04, -0.02};
  for (const Vector2& far_m : {Vector2(6.0, -8.0), Vector2(-10.0, 0.0), Vector2(0.0, 10.0)}) {
    EXPECT_LE((displaced(kA, by) * far_m - kA * far_m).norm(), as_seen_10_m_away(by));
  }
  EXPECT_NEAR(as_seen_10_m_away(by), 0.05 + 10.0 * 0.02, 1e-12);
}

}  // namespace
}  // namespace slammot::geometry
