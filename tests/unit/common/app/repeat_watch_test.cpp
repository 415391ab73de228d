#include "common/app/repeat_watch.hpp"

#include <gtest/gtest.h>

namespace slammot::app {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kNewestNs = 100'000 * kMs;

/// Of a process that began long ago.
RepeatWatch old_watch() {
  return RepeatWatch(std::chrono::steady_clock::now() - 10 * RepeatWatch::kBegins);
}

TEST(RepeatWatch, AlwaysAnswersTheNewestScan) {
  RepeatWatch watch = old_watch();
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(watch.asks_for_answer("front", kNewestNs, kNewestNs));
}

TEST(RepeatWatch, AnswersTheFirstOfASeriesAndOneInAQuarterOfASecond) {
  RepeatWatch watch = old_watch();
  int answers = 0;
  for (std::int64_t stamp_ns = 0; stamp_ns < 1000 * kMs; stamp_ns += 25 * kMs)
    answers += watch.asks_for_answer("front", stamp_ns, kNewestNs) ? 1 : 0;
  EXPECT_EQ(answers, 4);
}

TEST(RepeatWatch, AnswersASourceThatBeginsAgain) {
  RepeatWatch watch = old_watch();
  EXPECT_TRUE(watch.asks_for_answer("front", 50 * kMs, kNewestNs));
  EXPECT_FALSE(watch.asks_for_answer("front", 75 * kMs, kNewestNs));
  EXPECT_TRUE(watch.asks_for_answer("front", 50 * kMs, kNewestNs));
  EXPECT_TRUE(watch.asks_for_answer("front", 25 * kMs, kNewestNs));
}

TEST(RepeatWatch, AnswersNothingButTheNewestOfWhatTheBusGivesAProcessThatBegins) {
  const SteadyTime begun = std::chrono::steady_clock::now();
  RepeatWatch watch(begun);
  EXPECT_FALSE(watch.asks_for_answer("front", 50 * kMs, kNewestNs, begun));
  EXPECT_TRUE(watch.asks_for_answer("front", kNewestNs, kNewestNs, begun));
  EXPECT_EQ(watch.take_owed(), std::set<std::string>{"front"}) << "somebody may have repeated it";
  EXPECT_TRUE(watch.take_owed().empty());
  EXPECT_TRUE(watch.asks_for_answer("front", 50 * kMs, kNewestNs, begun + RepeatWatch::kBegins));
}

TEST(RepeatWatch, KeepsScannersApart) {
  RepeatWatch watch = old_watch();
  EXPECT_TRUE(watch.asks_for_answer("front", 50 * kMs, kNewestNs));
  EXPECT_TRUE(watch.asks_for_answer("rear", 75 * kMs, kNewestNs));
}

}  // namespace
}  // namespace slammot::app
