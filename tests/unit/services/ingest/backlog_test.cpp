#include "services/ingest/backlog.hpp"

#include <gtest/gtest.h>

namespace slammot::ingest {
namespace {

using namespace std::chrono_literals;

const Backlog::Time kStart{100s};
constexpr Backlog::Limits kLimits{.most_in_flight = 2, .longest_wait = 200ms, .silence = 100ms};

Step step_of(std::int64_t stamp_ns) {
  Step step;
  step.scan.emplace();
  step.scan->stamp_ns = stamp_ns;
  return step;
}

/// With two scans in flight, the first answered at the start.
struct BusyBacklog : ::testing::Test {
  BusyBacklog() {
    for (const std::int64_t stamp_ns : {1, 2, 3}) {
      backlog.add(step_of(stamp_ns), kStart);
      backlog.take();
    }
    backlog.answered(1, kStart);
  }
  Backlog backlog{kLimits};
};

TEST(Backlog, SendsAtOnceWhereNobodyHasAnsweredYet) {
  Backlog backlog(kLimits);
  for (std::int64_t stamp_ns = 0; stamp_ns < 10; ++stamp_ns) {
    backlog.add(step_of(stamp_ns), kStart);
    ASSERT_TRUE(backlog.may_send(kStart));
    EXPECT_EQ(backlog.take().scan->stamp_ns, stamp_ns);
  }
}

TEST_F(BusyBacklog, WaitsForAnAnswerWhileTooManyAreInFlight) {
  backlog.add(step_of(4), kStart + 1ms);
  EXPECT_FALSE(backlog.may_send(kStart + 1ms));
  backlog.answered(2, kStart + 2ms);
  EXPECT_TRUE(backlog.may_send(kStart + 2ms));
}

TEST_F(BusyBacklog, DropsTheOldestThatWaitTooLong) {
  for (std::int64_t i = 0; i < 5; ++i) backlog.add(step_of(10 + i), kStart + i * 50ms);
  EXPECT_EQ(backlog.drop_late(kStart + 200ms), 0U);
  EXPECT_EQ(backlog.drop_late(kStart + 251ms), 2U);
  backlog.answered(3, kStart + 251ms);
  EXPECT_EQ(backlog.take().scan->stamp_ns, 12);
}

TEST_F(BusyBacklog, DoesNotCountOdometryAsADroppedScan) {
  backlog.add({}, kStart);
  EXPECT_EQ(backlog.drop_late(kStart + 1s), 0U);
  EXPECT_TRUE(backlog.empty());
}

TEST_F(BusyBacklog, DoesNotWaitForServicesThatAreSilent) {
  backlog.add(step_of(4), kStart + 50ms);
  EXPECT_FALSE(backlog.may_send(kStart + 100ms));
  EXPECT_TRUE(backlog.may_send(kStart + 101ms));
}

TEST_F(BusyBacklog, HoldsBackAgainOnceTheyAnswer) {
  for (std::int64_t i = 0; i < 5; ++i) backlog.add(step_of(10 + i), kStart + 150ms);
  for (int i = 0; i < 3; ++i) backlog.take();
  EXPECT_TRUE(backlog.may_send(kStart + 150ms));
  backlog.answered(3, kStart + 150ms);
  EXPECT_FALSE(backlog.may_send(kStart + 150ms));
  backlog.answered(12, kStart + 160ms);
  EXPECT_TRUE(backlog.may_send(kStart + 160ms));
}

}  // namespace
}  // namespace slammot::ingest
