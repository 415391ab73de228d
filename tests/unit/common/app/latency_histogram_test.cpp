#include "common/app/latency_histogram.hpp"

#include <gtest/gtest.h>

namespace slammot::app {
namespace {

using namespace std::chrono_literals;

TEST(LatencyHistogram, SaysNothingBeforeTheFirstCall) {
  const LatencyHistogram histogram;
  EXPECT_EQ(histogram.count(), 0U);
  EXPECT_EQ(histogram.percentile_ms(0.5), 0.0);
}

TEST(LatencyHistogram, KnowsItsPercentilesToTenPercentOnTheSafeSide) {
  LatencyHistogram histogram;
  for (int ms = 1; ms <= 1000; ++ms) histogram.add(std::chrono::milliseconds(ms));
  for (const double share : {0.5, 0.9, 0.99}) {
    EXPECT_GE(histogram.percentile_ms(share), 1000.0 * share);
    EXPECT_LE(histogram.percentile_ms(share), 1.1 * 1000.0 * share);
  }
  EXPECT_EQ(histogram.highest_ms(), 1000.0);
}

TEST(LatencyHistogram, NeverSaysMoreThanTheSlowestCall) {
  LatencyHistogram histogram;
  histogram.add(1001us);
  EXPECT_DOUBLE_EQ(histogram.percentile_ms(0.99), 1.001);
}

TEST(LatencyHistogram, TakesCallsOfNoTimeAndOfHours) {
  LatencyHistogram histogram;
  histogram.add(0ns);
  EXPECT_DOUBLE_EQ(histogram.percentile_ms(1.0), 0.0);
  histogram.add(2h);
  EXPECT_EQ(histogram.count(), 2U);
  EXPECT_EQ(histogram.highest_ms(), 7.2e6);
}

}  // namespace
}  // namespace slammot::app
