#include "common/files/decimal.hpp"

#include <gtest/gtest.h>

namespace slammot::files {
namespace {

TEST(StampText, WritesTheLogsSixDecimals) {
  EXPECT_EQ(stamp_text(1'575'810'072'324'471'000), "1575810072.324471");
  EXPECT_EQ(stamp_text(21'019'900'000), "21.019900");
  EXPECT_EQ(stamp_text(0), "0.000000");
  EXPECT_EQ(stamp_text(-500'000'000), "-0.500000");
}

TEST(StampText, WritesNineDecimalsWhereSixWouldLoseSome) { EXPECT_EQ(stamp_text(1'123'456'789), "1.123456789"); }

TEST(FixedText, NeverWritesANegativeZero) {
  EXPECT_EQ(fixed_text(-0.0001, 3), "0.000");
  EXPECT_EQ(fixed_text(-0.1, 3), "-0.100");
  EXPECT_EQ(fixed_text(2.0, 0), "2");
  EXPECT_EQ(fixed_text(1e300, 1).size(), 303u);
}

}  // namespace
}  // namespace slammot::files
