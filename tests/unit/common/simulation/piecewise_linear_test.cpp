#include "common/simulation/piecewise_linear.hpp"

#include <gtest/gtest.h>

namespace slammot::simulation {
namespace {

struct Knot {
  double at = 0.0;
  double value = 0.0;
};

double at(double place) {
  const std::vector<Knot> knots{{1.0, 10.0}, {2.0, 20.0}, {4.0, 0.0}};
  return piecewise_linear(knots, &Knot::at, &Knot::value, place);
}

TEST(PiecewiseLinear, PassesThroughItsKnotsAndStraightBetweenThem) {
  EXPECT_DOUBLE_EQ(at(1.0), 10.0);
  EXPECT_DOUBLE_EQ(at(1.25), 12.5);
  EXPECT_DOUBLE_EQ(at(2.0), 20.0);
  EXPECT_DOUBLE_EQ(at(3.5), 5.0);
}

TEST(PiecewiseLinear, IsLevelOutside) {
  EXPECT_DOUBLE_EQ(at(-5.0), 10.0);
  EXPECT_DOUBLE_EQ(at(99.0), 0.0);
}

TEST(PiecewiseLinear, IsZeroWithoutKnots) {
  EXPECT_EQ(piecewise_linear(std::vector<Knot>{}, &Knot::at, &Knot::value, 1.0), 0.0);
}

}  // namespace
}  // namespace slammot::simulation
