#include "common/sensing/clock_jumps.hpp"

#include <gtest/gtest.h>

namespace slammot::sensing {
namespace {

using Stamps = std::vector<std::int64_t>;

TEST(WithoutJumps, KeepsAClockThatAdvances) {
  const Stamps stamps{0, 10, 20, 35, 40};
  EXPECT_EQ(without_jumps(stamps).stamps_ns, stamps);
  EXPECT_EQ(without_jumps(stamps).jumps, 0U);
}

TEST(WithoutJumps, GoesOnByTheUsualPeriodWhereTheClockWasSetBack) {
  const BridgedStamps bridged = without_jumps({1000, 1010, 1020, 5, 15, 25, 35});
  EXPECT_EQ(bridged.stamps_ns, (Stamps{1000, 1010, 1020, 1030, 1040, 1050, 1060}));
  EXPECT_EQ(bridged.jumps, 1U);
}

TEST(WithoutJumps, BridgesMoreThanTenMinutes) {
  constexpr std::int64_t kStep_ns = 100'000'000;
  constexpr std::int64_t kLater_ns = 700'000'000'000;
  Stamps stamps;
  for (std::int64_t i = 0; i < 10; ++i) stamps.push_back(i * kStep_ns + (i < 5 ? 0 : kLater_ns));
  const BridgedStamps bridged = without_jumps(stamps);
  EXPECT_EQ(bridged.jumps, 1U);
  EXPECT_EQ(bridged.stamps_ns.back(), 9 * kStep_ns);
}

TEST(WithoutJumps, KeepsASingleEarlyStamp) {
  const Stamps stamps{0, 10, 800'000'000'000, 30, 40, 50};
  EXPECT_EQ(without_jumps(stamps).stamps_ns, stamps);
}

}  // namespace
}  // namespace slammot::sensing
