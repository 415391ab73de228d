#include "common/geometry/geodetic.hpp"

#include <gtest/gtest.h>

namespace slammot::geometry {
namespace {

TEST(Geodetic, KnowsHowLongADegreeIs) {
  // WGS 84 at 45 degrees: 111,131.8 m to the north, 78,846.8 m to the east.
  const Geodetic origin{45.0, 7.0};
  EXPECT_NEAR(east_north_m(origin, {46.0, 7.0}).y(), 111131.8, 0.5);
  EXPECT_NEAR(east_north_m(origin, {45.0, 8.0}).x(), 78846.8, 0.5);
}

TEST(Geodetic, ComesBackToWhereItWas) {
  const Geodetic origin{-33.9, 151.2};
  const Vector2 place{1234.5, -987.6};
  EXPECT_TRUE(east_north_m(origin, geodetic_at(origin, place)).isApprox(place, 1e-9));
}

}  // namespace
}  // namespace slammot::geometry
