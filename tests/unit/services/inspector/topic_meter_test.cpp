#include "services/inspector/topic_meter.hpp"

#include <gtest/gtest.h>

namespace slammot::inspector {
namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST(TopicMeter, MeasuresRateSizeGapsAndDelay) {
  TopicMeter meter;
  for (std::int64_t i = 0; i < 100; ++i)
    meter.add(1000 * kMs + 10 * i * kMs, 1002 * kMs + 10 * i * kMs, 500);
  meter.add(2000 * kMs, 2050 * kMs, 1510);
  const TopicFigures figures = meter.figures(1.01);
  EXPECT_EQ(figures.samples, 101U);
  EXPECT_NEAR(figures.rate_hz, 100.0, 1e-9);
  EXPECT_NEAR(figures.mean_bytes, 510.0, 1e-9);
  EXPECT_NEAR(figures.shortest_gap_ms, 10.0, 1e-9);
  EXPECT_NEAR(figures.longest_gap_ms, 58.0, 1e-9);
  EXPECT_NEAR(figures.delay_p50_ms, 2.0, 1e-9);
  EXPECT_NEAR(figures.delay_p99_ms, 2.0, 1e-9);
  EXPECT_NEAR(figures.longest_delay_ms, 50.0, 1e-9);
}

TEST(TopicMeter, KeepsTotalAndAgeWhenAnIntervalBegins) {
  TopicMeter meter;
  EXPECT_LT(meter.age_s(0), 0.0);
  meter.add(1000 * kMs, 1000 * kMs, 1);
  meter.reset();
  EXPECT_EQ(meter.figures(1.0).samples, 0U);
  EXPECT_EQ(meter.total(), 1U);
  EXPECT_NEAR(meter.age_s(3500 * kMs), 2.5, 1e-9);
}

}  // namespace
}  // namespace slammot::inspector
