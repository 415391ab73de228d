#include "common/metrics/outline_seen.hpp"

#include <gtest/gtest.h>

#include "tests/unit/common/metrics/scenes.hpp"

namespace slammot::metrics {
namespace {

/// Sees a car of 4 m by 2 m all along a line.
void add_line(OutlinesSeen& outlines, const TrueObject& car, const geometry::Vector2& from_m,
              const geometry::Vector2& to_m) {
  constexpr int kEchoes = 81;
  for (int i = 0; i < kEchoes; ++i)
    outlines.add(car, car.world_from_object * (from_m + i / (kEchoes - 1.0) * (to_m - from_m)));
}

TEST(OutlinesSeen, CountTheSidesThatHadEchoes) {
  TrueObject car = car_at(10.0, 5.0);
  car.world_from_object.heading_rad = 0.7;
  OutlinesSeen outlines;
  EXPECT_EQ(outlines.share_of(car), 0.0);
  add_line(outlines, car, {-2.02, -0.9}, {-2.02, 0.9});
  EXPECT_NEAR(outlines.share_of(car), 2.0 / 12.0, 1e-9);
  add_line(outlines, car, {-1.9, 0.97}, {1.9, 0.97});
  EXPECT_NEAR(outlines.share_of(car), 6.0 / 12.0, 1e-9);
  add_line(outlines, car, {2.01, -0.9}, {2.01, 0.9});
  add_line(outlines, car, {-1.9, -1.05}, {1.9, -1.05});
  EXPECT_NEAR(outlines.share_of(car), 1.0, 1e-9);
}

TEST(OutlinesSeen, CountAnEchoTwiceOnlyOnce) {
  const TrueObject car = car_at(10.0, 5.0);
  OutlinesSeen outlines;
  outlines.add(car, {12.0, 5.1});
  outlines.add(car, {12.0, 5.1});
  EXPECT_NEAR(outlines.share_of(car), 1.0 / 24.0, 1e-9);
}

TEST(OutlinesSeen, KnowNothingOfObjectsWithoutASize) {
  TrueObject point = car_at(10.0, 5.0);
  point.length_m = 0.0;
  OutlinesSeen outlines;
  outlines.add(point, {10.0, 5.0});
  EXPECT_EQ(outlines.share_of(point), 0.0);
}

TEST(OutlinesSeen, KeepObjectsApart) {
  const TrueObject one = car_at(10.0, 5.0, 1);
  const TrueObject other = car_at(20.0, 5.0, 2);
  OutlinesSeen outlines;
  outlines.add(one, {12.0, 5.0});
  EXPECT_EQ(outlines.share_of(other), 0.0);
}

}  // namespace
}  // namespace slammot::metrics
