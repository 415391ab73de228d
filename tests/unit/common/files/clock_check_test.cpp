#include "common/files/clock_check.hpp"

#include <initializer_list>

#include <gtest/gtest.h>

namespace slammot::files {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;

ClockCheck check_of(std::initializer_list<std::int64_t> stamps_ns) {
  ClockCheck check;
  for (const std::int64_t stamp_ns : stamps_ns) check.add(stamp_ns);
  return check;
}

TEST(ClockCheck, TakesStampsThatAdvance) {
  EXPECT_TRUE(check_of({0, kSecondNs / 10, kSecondNs / 5, kSecondNs / 3}).is_usable());
  EXPECT_FALSE(ClockCheck().is_usable());
}

TEST(ClockCheck, DoesNotTakeACountOfScansOrAConstant) {
  EXPECT_FALSE(check_of({0, kSecondNs, 2 * kSecondNs, 3 * kSecondNs}).is_usable());
  EXPECT_FALSE(check_of({5, 5, 5, 5}).is_usable());
}

TEST(ClockCheck, LeavesOutAFirstStampFarAhead) {
  const ClockCheck check =
      check_of({1'000 * kSecondNs, kSecondNs / 10, kSecondNs / 5, kSecondNs / 3, kSecondNs / 2});
  EXPECT_TRUE(check.begins_ahead());
  EXPECT_TRUE(check.is_usable());
}

}  // namespace
}  // namespace slammot::files
