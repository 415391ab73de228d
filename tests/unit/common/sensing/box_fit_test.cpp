#include "common/sensing/box_fit.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace slammot::sensing {
namespace {

using Eigen::Vector2d;

constexpr double kRangeNoiseM = 0.03;

/// Echoes from the two sides of a car that meet in its corner, the long one at the heading.
std::vector<Vector2d> visible_corner(double heading_rad) {
  const Vector2d along{std::cos(heading_rad), std::sin(heading_rad)};
  const Vector2d across{-along.y(), along.x()};
  std::vector<Vector2d> points;
  for (double v = 1.8; v > 0.0; v -= 0.15) points.push_back(v * across);
  for (double u = 0.0; u <= 4.5; u += 0.15) points.push_back(u * along);
  return points;
}

class BoxFit : public ::testing::TestWithParam<double> {};

TEST_P(BoxFit, LaysItsSidesAlongTheSidesThatAreSeen) {
  const OrientedBox box = fit_box(visible_corner(GetParam()), kRangeNoiseM);
  EXPECT_NEAR(std::remainder(box.heading_rad - GetParam(), M_PI), 0.0, 0.03);
  EXPECT_NEAR(box.length_m, 4.5, 0.15);
  EXPECT_NEAR(box.width_m, 1.8, 0.15);
}

INSTANTIATE_TEST_SUITE_P(Headings, BoxFit, ::testing::Values(-1.2, -0.4, 0.0, 0.3, 0.8, 1.5));

/// A car at a tenth of the size seen from beside, with round corners.
TEST(BoxFitOfAModel, IsNotTurnedByItsRoundCorners) {
  const Vector2d along{std::cos(0.4), std::sin(0.4)};
  const Vector2d across{-along.y(), along.x()};
  std::vector<Vector2d> points;
  for (double u = -0.04; u < 0.0; u += 0.01) points.push_back(u * along + u * u / 0.04 * across);
  for (double u = 0.0; u < 0.36; u += 0.01) points.push_back(u * along);
  EXPECT_NEAR(std::remainder(fit_box(points, 0.01).heading_rad - 0.4, M_PI), 0.0, 0.03);
  EXPECT_GT(std::abs(std::remainder(fit_box(points, kRangeNoiseM).heading_rad - 0.4, M_PI)), 0.03)
      << "else the noise need not be told";
}

TEST(BoxFitOfFewPoints, IsALineOrAPoint) {
  const std::vector<Vector2d> two = {{1.0, 1.0}, {2.0, 2.0}};
  EXPECT_NEAR(fit_box(two, kRangeNoiseM).heading_rad, M_PI / 4.0, 1e-9);
  EXPECT_NEAR(fit_box(two, kRangeNoiseM).length_m, std::sqrt(2.0), 1e-9);
  const std::vector<Vector2d> one = {{1.0, 1.0}};
  EXPECT_EQ(fit_box(one, kRangeNoiseM).length_m, 0.0);
}

TEST(BoxAtHeading, CallsTheLongerSideItsLength) {
  const std::vector<Vector2d> points = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 3.0}};
  const OrientedBox box = box_at_heading(points, 0.0);
  EXPECT_DOUBLE_EQ(box.length_m, 3.0);
  EXPECT_DOUBLE_EQ(box.width_m, 1.0);
  EXPECT_NEAR(box.heading_rad, M_PI / 2.0, 1e-12);
}

TEST(OrientedBox, TellsHowFarAPointIsFromItsSides) {
  const BoxSides sides(OrientedBox{{1.0, 2.0}, 0.5 * M_PI, 4.0, 2.0});
  EXPECT_NEAR(sides.distance_m({1.0, 2.0}), 1.0, 1e-12);
  EXPECT_NEAR(sides.distance_m({1.0, 3.75}), 0.25, 1e-12);
  EXPECT_NEAR(sides.distance_m({1.5, 5.0}), 1.0, 1e-12);
  EXPECT_NEAR(sides.distance_m({2.3, 4.4}), 0.5, 1e-12) << "a corner";
}

}  // namespace
}  // namespace slammot::sensing
