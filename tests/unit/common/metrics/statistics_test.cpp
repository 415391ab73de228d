#include "common/metrics/statistics.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace slammot::metrics {
namespace {

TEST(Summarize, KnowsTheErrorsOfFiveByHand) {
  const ErrorSummary summary = summarize({3.0, 1.0, 2.0, 5.0, 4.0});
  EXPECT_EQ(summary.count, 5U);
  EXPECT_DOUBLE_EQ(summary.mean, 3.0);
  EXPECT_DOUBLE_EQ(summary.median, 3.0);
  EXPECT_DOUBLE_EQ(summary.max, 5.0);
  EXPECT_DOUBLE_EQ(summary.rmse, std::sqrt(11.0));
  EXPECT_DOUBLE_EQ(summary.p95, 4.8);
}

TEST(Summarize, TakesTheMeanOfTheMiddleTwoOfAnEvenCount) {
  EXPECT_DOUBLE_EQ(summarize({4.0, 1.0, 3.0, 10.0}).median, 3.5);
}

TEST(Summarize, IsAllZeroForNothing) {
  EXPECT_EQ(summarize({}).count, 0U);
  EXPECT_EQ(summarize({}).rmse, 0.0);
}

}  // namespace
}  // namespace slammot::metrics
