#include "common/matching/body.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace slammot::matching {
namespace {

using geometry::Vector2;

constexpr double kLongest_m = 5.0;

TEST(Body, EndsAtAGap) {
  const Vector2 first(10.0, 0.0);
  const Vector2 last(10.0, 1.0);
  EXPECT_TRUE(continues_body(first, last, {10.0, 1.5}, kLongest_m));
  EXPECT_FALSE(continues_body(first, last, {10.0, 1.7}, kLongest_m));
}

TEST(Body, HasPointsFartherApartWhereItIsFarAway) {
  EXPECT_FALSE(continues_body({5.0, 0.0}, {5.0, 1.0}, {5.0, 1.8}, kLongest_m));
  EXPECT_TRUE(continues_body({40.0, 0.0}, {40.0, 1.0}, {40.0, 1.8}, kLongest_m));
}

TEST(Body, IsNoLongerThanTheLongest) {
  const Vector2 first(3.0, -2.0);
  EXPECT_TRUE(continues_body(first, {3.0, 2.8}, {3.0, 2.9}, kLongest_m));
  EXPECT_FALSE(continues_body(first, {3.0, 2.9}, {3.0, 3.1}, kLongest_m));
}

struct Side {
  double from_x_m;
  int points;  ///< A decimetre apart.
};

/// Of a scan that sees these sides 3 m to the left.
std::size_t independent_of(const std::vector<Side>& sides) {
  std::vector<MatchPoint> points;
  for (const Side& side : sides)
    for (int i = 0; i < side.points; ++i) points.push_back({{side.from_x_m + 0.1 * i, 3.0}});
  return independent_points(points, kLongest_m);
}

TEST(IndependentPoints, AreNoneOfOneBody) {
  EXPECT_EQ(independent_of({}), 0U);
  EXPECT_EQ(independent_of({{0.0, 40}}), 0U);
}

TEST(IndependentPoints, OfTheLargestBodyAreNoMoreThanAllOthers) {
  EXPECT_EQ(independent_of({{-8.0, 5}, {0.0, 40}, {7.0, 10}}), 30U);
}

TEST(IndependentPoints, AreAllWhereNoBodyHasMost) {
  EXPECT_EQ(independent_of({{-8.0, 20}, {0.0, 30}, {7.0, 20}}), 70U);
}

}  // namespace
}  // namespace slammot::matching
