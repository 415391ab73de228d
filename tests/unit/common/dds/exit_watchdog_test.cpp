#include "common/dds/exit_watchdog.hpp"

#include <cstdlib>

#include <gtest/gtest.h>

namespace slammot::dds {
namespace {

using namespace std::chrono_literals;

TEST(ExitWatchdogDeathTest, EndsAProcessThatHangsOnItsWayOut) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        ExitWatchdog watchdog(10ms);
        watchdog.arm();
        std::mutex never_unlocked;
        std::unique_lock lock(never_unlocked);
        std::condition_variable never_notified;
        never_notified.wait(lock, [] { return false; });
      },
      ::testing::ExitedWithCode(ExitWatchdog::kExitCode),
      "leaving the DDS bus took longer than 10 ms");
}

TEST(ExitWatchdogDeathTest, LetsAProcessGoThatLeavesInTime) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        {
          ExitWatchdog watchdog(60'000ms);
          watchdog.arm();
        }
        std::exit(0);
      },
      ::testing::ExitedWithCode(0), "");
}

TEST(ExitWatchdogDeathTest, DoesNothingUnlessArmed) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        const ExitWatchdog never_armed(0ms);
        ExitWatchdog armed(50ms);
        armed.arm();
        std::mutex never_unlocked;
        std::unique_lock lock(never_unlocked);
        std::condition_variable never_notified;
        never_notified.wait(lock, [] { return false; });
      },
      ::testing::ExitedWithCode(ExitWatchdog::kExitCode), "took longer than 50 ms");
}

}  // namespace
}  // namespace slammot::dds
