#include "common/app/scan_latency.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace slammot::app {
namespace {

constexpr std::int64_t kNowNs = 1'800'000'000'000'000'000;

TEST(ScanLatency, IsTheTimeSinceTheScanWasPublished) {
  LatencyHistogram histogram;
  add_since_scan(histogram, kNowNs - 3'000'000, kNowNs);
  EXPECT_EQ(histogram.count(), 1U);
  EXPECT_NEAR(histogram.highest_ms(), 3.0, 1e-9);
}

TEST(ScanLatency, LeavesOutWhatIsNoLatency) {
  LatencyHistogram histogram;
  add_since_scan(histogram, 0, kNowNs);                                    // unknown
  add_since_scan(histogram, kNowNs + 50'000'000, kNowNs);                  // clocks apart
  add_since_scan(histogram, kNowNs - 86'400'000'000'000, kNowNs);          // a recording is played
  add_since_scan(histogram, std::numeric_limits<std::int64_t>::min(), 1);  // a hostile publisher
  EXPECT_EQ(histogram.count(), 0U);
}

}  // namespace
}  // namespace slammot::app
