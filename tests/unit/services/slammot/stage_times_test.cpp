#include "services/slammot/stage_times.hpp"

#include <gtest/gtest.h>

namespace slammot {
namespace {

TEST(StageTimes, CountsCallsInTheOrderOfFirstUseAndReturnsResults) {
  StageTimes times;
  EXPECT_EQ(times.measure("localization", [] { return 7; }), 7);
  times.measure("detection", [] {});
  times.measure("localization", [] {});
  const auto stages = times.summary();
  ASSERT_EQ(stages.size(), 2u);
  EXPECT_EQ(stages[0].stage, "localization");
  EXPECT_EQ(stages[0].calls, 2u);
  EXPECT_EQ(stages[1].stage, "detection");
  EXPECT_GE(stages[0].max_ms, stages[0].p50_ms);
}

}  // namespace
}  // namespace slammot
