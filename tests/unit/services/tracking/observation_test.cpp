#include "services/tracking/observation.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;

/// By brute force.
double diameter_m(const std::vector<Vector2d>& points_m) {
  double diameter_m = 0.0;
  for (const Vector2d& a : points_m)
    for (const Vector2d& b : points_m) diameter_m = std::max(diameter_m, (a - b).norm());
  return diameter_m;
}

TEST(Observation, SpansItsDiameterToWithinEightPercent) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-3.0, 3.0);
  for (int i = 0; i < 200; ++i) {
    std::vector<Vector2d> points_m;
    for (int point = 0; point < 6; ++point)
      points_m.emplace_back(place(random), 0.3 * place(random));
    EXPECT_LE(largest_span_m(points_m), diameter_m(points_m) + 1e-9);
    EXPECT_GE(largest_span_m(points_m), 0.92 * diameter_m(points_m));
  }
}

TEST(Observation, OfOnePointSpansNothing) {
  const std::vector<Vector2d> points_m = {{4.0, 5.0}};
  EXPECT_EQ(largest_span_m(points_m), 0.0);
}

TEST(Observation, HasTheMeanGapOfIndependentResponses) {
  Observation observation;
  EXPECT_EQ(mean_gap(observation), 0.0);
  observation.unanswered_share = 0.75;
  double expected = 0.0;  // of a geometric distribution
  for (int length = 1; length < 200; ++length) expected += length * std::pow(0.75, length) * 0.25;
  EXPECT_NEAR(mean_gap(observation), expected, 1e-9);
}

}  // namespace
}  // namespace slammot::tracking
