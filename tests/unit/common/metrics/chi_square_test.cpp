#include "common/metrics/chi_square.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace slammot::metrics {
namespace {

TEST(ChiSquare, WithTwoDegreesOfFreedomIsTheClosedForm) {
  for (const double value : {0.01, 1.0, 5.991, 30.0})
    EXPECT_NEAR(chi_square_cdf(value, 2.0), 1.0 - std::exp(-0.5 * value), 1e-14);
}

TEST(ChiSquare, WithOneDegreeOfFreedomIsASquaredNormal) {
  for (const double value : {0.1, 1.0, 3.841})
    EXPECT_NEAR(chi_square_cdf(value, 1.0), std::erf(std::sqrt(0.5 * value)), 1e-13);
}

TEST(ChiSquare, HasTheQuantilesOfPrintedTables) {
  EXPECT_NEAR(chi_square_quantile(0.95, 3.0), 7.815, 5e-4);
  EXPECT_NEAR(chi_square_quantile(0.025, 10.0), 3.247, 5e-4);
  EXPECT_NEAR(chi_square_quantile(0.975, 100.0), 129.561, 5e-4);
}

TEST(ChiSquare, QuantileUndoesTheDistributionForManyDegreesOfFreedom) {
  for (const double degrees : {3.0, 300.0, 30000.0})
    EXPECT_NEAR(chi_square_cdf(chi_square_quantile(0.975, degrees), degrees), 0.975, 1e-9);
}

TEST(ChiSquare, HasNothingBelowZero) { EXPECT_EQ(chi_square_cdf(-1.0, 3.0), 0.0); }

}  // namespace
}  // namespace slammot::metrics
