#include "services/ingest/backlog.hpp"

#include <gtest/gtest.h>

namespace slammot::ingest {
namespace {

using namespace std::chrono_literals;
using Answer = Backlog::Answer;

const Backlog::Time kStart{100s};
constexpr Backlog::Limits kLimits{
    .most_in_flight = 2, .longest_wait = 150ms, .label_silence = 150ms, .absence = 500ms};

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
      backlog.take(kStart);
    }
    backlog.answered(Answer::kLocalized, 1, kStart);
    backlog.answered(Answer::kLabelled, 1, kStart);
  }
  /// Answers to nothing that is in flight, every 10 ms.
  void keep_answering(std::chrono::milliseconds from, std::chrono::milliseconds to) {
    for (auto at = from; at <= to; at += 10ms) backlog.answered(Answer::kLabelled, 1, kStart + at);
  }
  Backlog backlog{kLimits};
};

TEST(Backlog, SendsAtOnceWhereNobodyHasAnsweredYet) {
  Backlog backlog(kLimits);
  for (std::int64_t stamp_ns = 0; stamp_ns < 10; ++stamp_ns) {
    backlog.add(step_of(stamp_ns), kStart);
    ASSERT_TRUE(backlog.may_send(kStart));
    EXPECT_EQ(backlog.take(kStart).scan->stamp_ns, stamp_ns);
  }
}

TEST_F(BusyBacklog, WaitsForAnAnswerWhileTooManyAreInFlight) {
  backlog.add(step_of(4), kStart + 1ms);
  EXPECT_FALSE(backlog.may_send(kStart + 1ms));
  backlog.answered(Answer::kLabelled, 2, kStart + 2ms);
  EXPECT_TRUE(backlog.may_send(kStart + 2ms));
}

TEST_F(BusyBacklog, WaitsForLabelsAsLongAsTheyCome) {
  backlog.add(step_of(4), kStart + 1ms);
  backlog.answered(Answer::kLocalized, 3, kStart + 2ms);
  EXPECT_FALSE(backlog.may_send(kStart + 2ms));
}

TEST_F(BusyBacklog, LetsLocalizationGoOnWithoutLabels) {
  backlog.add(step_of(4), kStart + 1ms);
  backlog.answered(Answer::kLocalized, 3, kStart + 2ms);
  EXPECT_FALSE(backlog.may_send(kStart + 150ms));
  EXPECT_TRUE(backlog.may_send(kStart + 151ms));
}

TEST_F(BusyBacklog, HoldsWhatLocalizationHasNotAnsweredAlsoWithoutLabels) {
  for (const std::int64_t stamp_ns : {4, 5, 6}) backlog.add(step_of(stamp_ns), kStart + 1ms);
  backlog.answered(Answer::kLocalized, 3, kStart + 151ms);
  while (backlog.may_send(kStart + 160ms)) backlog.take(kStart + 160ms);
  EXPECT_FALSE(backlog.empty());
}

TEST_F(BusyBacklog, HasOneScanInFlightAfterASlowAnswerUntilAnswersAreQuickAgain) {
  for (std::int64_t stamp_ns = 4; stamp_ns < 10; ++stamp_ns) backlog.add(step_of(stamp_ns), kStart);
  backlog.answered(Answer::kLabelled, 3, kStart + 110ms);
  backlog.take(kStart + 110ms);
  EXPECT_FALSE(backlog.may_send(kStart + 110ms));
  backlog.answered(Answer::kLabelled, 4, kStart + 120ms);
  backlog.take(kStart + 120ms);
  EXPECT_TRUE(backlog.may_send(kStart + 120ms));
}

TEST_F(BusyBacklog, DropsTheOldestThatWaitTooLong) {
  for (std::int64_t i = 0; i < 5; ++i) backlog.add(step_of(10 + i), kStart + i * 50ms);
  keep_answering(10ms, 150ms);
  EXPECT_EQ(backlog.drop_late(), 0U);
  keep_answering(160ms, 210ms);
  EXPECT_EQ(backlog.drop_late(), 2U);
  backlog.answered(Answer::kLabelled, 3, kStart + 211ms);
  EXPECT_EQ(backlog.take(kStart + 211ms).scan->stamp_ns, 12);
}

TEST_F(BusyBacklog, DoesNotCountOdometryAsADroppedScan) {
  backlog.add({}, kStart);
  keep_answering(10ms, 300ms);
  EXPECT_EQ(backlog.drop_late(), 0U);
  EXPECT_TRUE(backlog.empty());
}

TEST_F(BusyBacklog, KeepsScansThroughASilenceOfTheServices) {
  for (std::int64_t i = 0; i < 10; ++i) backlog.add(step_of(10 + i), kStart + i * 40ms);
  EXPECT_EQ(backlog.drop_late(), 0U);
  backlog.answered(Answer::kLabelled, 3, kStart + 400ms);
  EXPECT_EQ(backlog.drop_late(), 0U) << "the services have had no time for them";
  keep_answering(410ms, 560ms);
  EXPECT_EQ(backlog.drop_late(), 10U);
}

TEST_F(BusyBacklog, SendsOnWhereTheServicesAreGone) {
  for (std::int64_t i = 0; i < 10; ++i) backlog.add(step_of(10 + i), kStart + 10ms);
  EXPECT_FALSE(backlog.may_send(kStart + 500ms));
  while (backlog.may_send(kStart + 501ms)) backlog.take(kStart + 501ms);
  EXPECT_TRUE(backlog.empty());
}

TEST_F(BusyBacklog, HoldsBackAgainOnceTheyAnswer) {
  for (std::int64_t i = 0; i < 5; ++i) backlog.add(step_of(10 + i), kStart + 550ms);
  for (int i = 0; i < 3; ++i) backlog.take(kStart + 550ms);
  EXPECT_TRUE(backlog.may_send(kStart + 550ms));
  backlog.answered(Answer::kLabelled, 3, kStart + 550ms);
  EXPECT_FALSE(backlog.may_send(kStart + 550ms));
  backlog.answered(Answer::kLabelled, 12, kStart + 560ms);
  EXPECT_TRUE(backlog.may_send(kStart + 560ms));
}

}  // namespace
}  // namespace slammot::ingest
