#include "common/traffic/ways_pace.hpp"

#include <gtest/gtest.h>

namespace slammot::traffic {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;

TEST(WaysPace, IsDueBeforeTheFirstTime) { EXPECT_TRUE(WaysPace().is_due(0, 400'000)); }

TEST(WaysPace, WaitsForTheStampsOfTheData) {
  WaysPace pace;
  pace.found(100 * kSecondNs);
  EXPECT_FALSE(pace.is_due(100 * kSecondNs, 10));
  EXPECT_FALSE(pace.is_due(102 * kSecondNs - 1, 10));
  EXPECT_TRUE(pace.is_due(102 * kSecondNs, 10));
}

TEST(WaysPace, WaitsLongerInALargeMap) {
  WaysPace pace;
  pace.found(100 * kSecondNs);
  EXPECT_FALSE(pace.is_due(139 * kSecondNs, 400'000));
  EXPECT_TRUE(pace.is_due(140 * kSecondNs, 400'000));
}

TEST(WaysPace, GoesOnAfterTheClockWasSetBack) {
  WaysPace pace;
  pace.found(100 * kSecondNs);
  EXPECT_TRUE(pace.is_due(50 * kSecondNs, 10));
}

}  // namespace
}  // namespace slammot::traffic
