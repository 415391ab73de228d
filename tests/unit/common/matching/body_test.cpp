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

/// So many points a decimetre apart, from there on.
void add_side(const Vector2& from_m, int count, std::vector<MatchPoint>& points) {
  for (int i = 0; i < count; ++i) points.push_back({from_m + Vector2(0.1 * i, 0.0)});
}

TEST(IndependentPoints, AreNoneOfOneBody) {
  std::vector<MatchPoint> points;
  EXPECT_EQ(independent_points(points, kLongest_m), 0U);
  add_side({0.0, 3.0}, 40, points);
  EXPECT_EQ(independent_points(points, kLongest_m), 0U);
}

TEST(IndependentPoints, OfTheLargestBodyAreNoMoreThanAllOthers) {
  std::vector<MatchPoint> points;
  add_side({-8.0, 3.0}, 5, points);
  add_side({0.0, 3.0}, 40, points);
  add_side({7.0, 3.0}, 10, points);
  EXPECT_EQ(independent_points(points, kLongest_m), 30U);
}

TEST(IndependentPoints, AreAllWhereNoBodyHasMost) {
  std::vector<MatchPoint> points;
  add_side({-8.0, 3.0}, 20, points);
  add_side({0.0, 3.0}, 30, points);
  add_side({7.0, 3.0}, 20, points);
  EXPECT_EQ(independent_points(points, kLongest_m), 70U);
}

}  // namespace
}  // namespace slammot::matching
