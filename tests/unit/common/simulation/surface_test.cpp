#include "common/simulation/surface.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace slammot::simulation {
namespace {

using geometry::Vector2;

TEST(DistanceAlongRay, MeetsASegmentWhereItCrosses) {
  const Segment wall{{5.0, -1.0}, {5.0, 1.0}, Material::wall};
  EXPECT_DOUBLE_EQ(distance_along_ray(wall, {1.0, 0.5}, {1.0, 0.0}), 4.0);
}

TEST(DistanceAlongRay, MissesASegmentBesideOrBehind) {
  const Segment wall{{5.0, -1.0}, {5.0, 1.0}, Material::wall};
  EXPECT_TRUE(std::isinf(distance_along_ray(wall, {1.0, 1.5}, {1.0, 0.0})));
  EXPECT_TRUE(std::isinf(distance_along_ray(wall, {6.0, 0.0}, {1.0, 0.0})));
}

TEST(DistanceAlongRay, MissesASegmentSeenEdgeOn) {
  const Segment wall{{5.0, 0.0}, {7.0, 0.0}, Material::wall};
  EXPECT_TRUE(std::isinf(distance_along_ray(wall, {0.0, 0.0}, {1.0, 0.0})));
}

TEST(DistanceAlongRay, MeetsACircleOnItsNearSide) {
  const Circle trunk{{10.0, 0.0}, 0.5, Material::post};
  EXPECT_DOUBLE_EQ(distance_along_ray(trunk, {0.0, 0.0}, {1.0, 0.0}), 9.5);
  EXPECT_NEAR(distance_along_ray(trunk, {0.0, 0.3}, {1.0, 0.0}), 10.0 - 0.4, 1e-12);
  EXPECT_TRUE(std::isinf(distance_along_ray(trunk, {0.0, 0.6}, {1.0, 0.0})));
  EXPECT_TRUE(std::isinf(distance_along_ray(trunk, {20.0, 0.0}, {1.0, 0.0})));
}

TEST(CutRectangle, KeepsLengthAndWidth) {
  double length_m = 0.0;
  double width_m = 0.0;
  for (const Vector2& corner : cut_rectangle(4.5, 1.8, 0.3)) {
    length_m = std::max(length_m, 2.0 * corner.x());
    width_m = std::max(width_m, 2.0 * corner.y());
  }
  EXPECT_DOUBLE_EQ(length_m, 4.5);
  EXPECT_DOUBLE_EQ(width_m, 1.8);
}

}  // namespace
}  // namespace slammot::simulation
