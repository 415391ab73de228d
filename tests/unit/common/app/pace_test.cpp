#include "common/app/pace.hpp"

#include <gtest/gtest.h>

namespace slammot::app {
namespace {

using namespace std::chrono_literals;

const Pace::Time kStart{100s};
constexpr std::int64_t kSecondNs = 1'000'000'000;

TEST(Pace, UnderstandsMaxAndNumbers) {
  EXPECT_TRUE(Pace::parse("max")->is_unlimited());
  EXPECT_FALSE(Pace::parse("0.5")->is_unlimited());
  for (const char* nonsense : {"", "fast", "0", "-1", "1x", "nan", "inf", "1e9"})
    EXPECT_FALSE(Pace::parse(nonsense)) << nonsense;
}

TEST(Pace, PlaysAtItsMultipleOfTheRecordedSpeed) {
  Pace pace = *Pace::parse("4");
  EXPECT_EQ(pace.due(50 * kSecondNs, kStart), kStart);
  EXPECT_EQ(pace.due(54 * kSecondNs, kStart + 1ms), kStart + 1s);
  EXPECT_EQ(pace.due(58 * kSecondNs, kStart + 1500ms), kStart + 2s);
}

TEST(Pace, DoesNotWaitForALeapOfTheLogsClock) {
  Pace pace = *Pace::parse("1");
  pace.due(50 * kSecondNs, kStart);
  EXPECT_EQ(pace.due(5000 * kSecondNs, kStart + 1s), kStart + 1s);
  EXPECT_EQ(pace.due(10 * kSecondNs, kStart + 2s), kStart + 2s);
  EXPECT_EQ(pace.due(11 * kSecondNs, kStart + 2s), kStart + 3s);
}

TEST(Pace, BeginsAnewWhenRestarted) {
  Pace pace = *Pace::parse("1");
  pace.due(0, kStart);
  pace.restart();
  EXPECT_EQ(pace.due(30 * kSecondNs, kStart + 2s), kStart + 2s);
}

}  // namespace
}  // namespace slammot::app
