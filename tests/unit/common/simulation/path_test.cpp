#include "common/simulation/path.hpp"

#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"

namespace slammot::simulation {
namespace {

using geometry::Pose2;
using slammot::testing::PoseNear;

TEST(Path, RunsAlongAStraightLineByArcLength) {
  const Path path(line({1.0, 2.0}, {1.0, 12.0}, 0.5));
  EXPECT_NEAR(path.length_m(), 10.0, 1e-9);
  EXPECT_THAT(path.pose_at(4.0), PoseNear(Pose2{1.0, 6.0, 0.5 * std::numbers::pi}, 1e-9));
}

TEST(Path, GoesStraightOnBeyondItsEnds) {
  const Path path(line({0.0, 0.0}, {10.0, 0.0}, 0.5));
  EXPECT_THAT(path.pose_at(-3.0), PoseNear(Pose2{-3.0, 0.0, 0.0}, 1e-9));
  EXPECT_THAT(path.pose_at(13.0), PoseNear(Pose2{13.0, 0.0, 0.0}, 1e-9));
}

TEST(Path, TurnsSmoothlyThroughABend) {
  const Path path(bezier({0.0, 0.0}, {5.5, 0.0}, {10.0, 4.5}, {10.0, 10.0}, 0.25));
  double last_heading_rad = path.pose_at(0.0).heading_rad;
  for (double arc_m = 0.05; arc_m < path.length_m(); arc_m += 0.05) {
    const double heading_rad = path.pose_at(arc_m).heading_rad;
    EXPECT_NEAR(heading_rad, last_heading_rad, 0.02);  // no jump, where the radius is near 10 m
    last_heading_rad = heading_rad;
  }
  EXPECT_NEAR(last_heading_rad, 0.5 * std::numbers::pi, 0.05);
}

}  // namespace
}  // namespace slammot::simulation
