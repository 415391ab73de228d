#include "common/metrics/nees.hpp"

#include <random>

#include <gtest/gtest.h>

namespace slammot::metrics {
namespace {

/// Squared lengths of vectors drawn from a Gaussian of the given standard deviation in each of
/// three directions.
std::vector<double> squared_errors(double sigma, std::size_t count) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0.0, sigma);
  std::vector<double> squares;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = normal(random), y = normal(random), z = normal(random);
    squares.push_back(x * x + y * y + z * z);
  }
  return squares;
}

TEST(Nees, OfHonestCovariancesIsInsideTheBandAroundTheDegreesOfFreedom) {
  const NeesSummary summary = summarize_nees(squared_errors(1.0, 500), 3);
  EXPECT_LT(summary.band_low, 3.0);
  EXPECT_GT(summary.band_high, 3.0);
  EXPECT_TRUE(summary.is_inside());
}

TEST(Nees, OfErrorsAFifthLargerThanPromisedIsOutside) {
  EXPECT_FALSE(summarize_nees(squared_errors(1.2, 500), 3).is_inside());
}

TEST(Nees, OfErrorsAFifthSmallerThanPromisedIsOutside) {
  EXPECT_FALSE(summarize_nees(squared_errors(0.8, 500), 3).is_inside());
}

TEST(Nees, OfNothingIsNotInside) { EXPECT_FALSE(summarize_nees({}, 3).is_inside()); }

}  // namespace
}  // namespace slammot::metrics
