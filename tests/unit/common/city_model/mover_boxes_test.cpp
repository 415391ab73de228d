#include "common/city_model/mover_boxes.hpp"

#include <gtest/gtest.h>

namespace slammot::city_model {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// 4 m x 2 m, at 10 m/s along x, seen from 0 s to 1 s.
MoverBoxes one_car() {
  MoverBoxes boxes({.margin_m = 0.5, .before_s = 2.0, .after_s = 3.0});
  boxes.add(7, {0, {0.0, 5.0, 0.0}, {10.0, 0.0}, 4.0, 2.0});
  boxes.add(7, {kSecond_ns, {10.0, 5.0, 0.0}, {10.0, 0.0}, 4.0, 2.0});
  return boxes;
}

double x_at(const MoverBoxes& boxes, double time_s) {
  const auto at = boxes.at(static_cast<std::int64_t>(time_s * 1e9));
  return at.empty() ? std::numeric_limits<double>::quiet_NaN() : at.front().map_from_object.x_m;
}

TEST(MoverBoxes, AreInterpolatedBetweenScans) { EXPECT_NEAR(x_at(one_car(), 0.4), 4.0, 1e-9); }

TEST(MoverBoxes, MoveOnWhereTheTrackingScannerNoLongerSees) {
  EXPECT_NEAR(x_at(one_car(), 2.0), 20.0, 1e-9);
  EXPECT_NEAR(x_at(one_car(), -1.0), -10.0, 1e-9);
}

TEST(MoverBoxes, EndSomeSecondsAfterTheTrack) {
  EXPECT_TRUE(one_car().at(5 * kSecond_ns).empty());
  EXPECT_TRUE(one_car().at(-3 * kSecond_ns).empty());
}

TEST(MoverBoxes, CoverTheMarginAroundTheBoxInItsHeading) {
  const TrackedBox box{0, {0.0, 0.0, 1.5707963}, {0.0, 0.0}, 5.0, 3.0};
  EXPECT_TRUE(contains(box, {1.4, 2.4}));
  EXPECT_FALSE(contains(box, {1.6, 0.0}));
  EXPECT_FALSE(contains(box, {0.0, 2.6}));
}

}  // namespace
}  // namespace slammot::city_model
