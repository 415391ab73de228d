#include "services/collision_warning/oriented_box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace slammot::collision_warning {
namespace {

using geometry::Pose2;
using geometry::Vector2;

/// Oracle: the least distance of a fine grid of points of `a` to `b`.
double distance_by_points_m(const OrientedBox& a, const OrientedBox& b) {
  constexpr int kSteps = 60;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const Vector2 in_a{a.length_m * (static_cast<double>(i) / kSteps - 0.5),
                         a.width_m * (static_cast<double>(j) / kSteps - 0.5)};
      const Vector2 in_b = inverse(b.centre) * (a.centre * in_a);
      const Vector2 outside{std::max(0.0, std::abs(in_b.x()) - 0.5 * b.length_m),
                            std::max(0.0, std::abs(in_b.y()) - 0.5 * b.width_m)};
      nearest_m = std::min(nearest_m, outside.norm());
    }
  }
  return nearest_m;
}

OrientedBox box_somewhere(std::mt19937& random) {
  std::uniform_real_distribution<double> place(-4.0, 4.0);
  std::uniform_real_distribution<double> heading(-3.1, 3.1);
  std::uniform_real_distribution<double> size(0.5, 4.0);
  return {Pose2{place(random), place(random), heading(random)}, size(random), size(random)};
}

TEST(OrientedBox, DistanceIsThatOfTheNearestPoints) {
  std::mt19937 random(1);
  int apart = 0;
  for (int i = 0; i < 200; ++i) {
    const OrientedBox a = box_somewhere(random);
    const OrientedBox b = box_somewhere(random);
    const double expected_m = distance_by_points_m(a, b);
    EXPECT_NEAR(distance_m(a, b), expected_m, 0.07);
    EXPECT_NEAR(distance_m(a, b), distance_m(b, a), 1e-12);
    if (expected_m > 0.0) ++apart;
  }
  EXPECT_GT(apart, 50);
  EXPECT_LT(apart, 150);
}

TEST(OverlapTest, MovesTheSecondBox) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> shift(-3.0, 3.0);
  for (int i = 0; i < 200; ++i) {
    const OrientedBox a = box_somewhere(random);
    const OrientedBox b = box_somewhere(random);
    const Vector2 shift_m{shift(random), shift(random)};
    OrientedBox moved = b;
    moved.centre.x_m += shift_m.x();
    moved.centre.y_m += shift_m.y();
    EXPECT_EQ(OverlapTest(a, b).overlaps(shift_m), OverlapTest(a, moved).overlaps(Vector2::Zero()));
  }
}

TEST(OverlapTest, ClearanceIsNeverMoreThanTheDistance) {
  std::mt19937 random(3);
  for (int i = 0; i < 200; ++i) {
    const OrientedBox a = box_somewhere(random);
    const OrientedBox b = box_somewhere(random);
    EXPECT_LE(OverlapTest(a, b).clearance_m(), distance_m(a, b) + 1e-9);
  }
}

}  // namespace
}  // namespace slammot::collision_warning
