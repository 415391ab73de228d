#include "common/files/decimal.hpp"

#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

namespace slammot::files {
namespace {

std::string printed(const char* format, int precision, double value) {
  char text[400];
  std::snprintf(text, sizeof text, format, precision, value);
  return text;
}

/// Of all sizes, and among them many of few digits, which lie in the middle between two shorter
/// ones.
template <typename Check>
void for_many_numbers(Check check) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> exponent(-16.0, 17.0);
  std::uniform_int_distribution<std::int64_t> whole(-2'000'000, 2'000'000);
  std::uniform_int_distribution<int> shift(0, 16);
  for (int i = 0; i < 40'000; ++i) {
    check(std::copysign(std::pow(10.0, exponent(random)), static_cast<double>(whole(random))));
    check(static_cast<double>(whole(random)) / std::exp2(shift(random)));
    check(static_cast<double>(whole(random)) / std::pow(10.0, shift(random)));
    const double power = std::pow(10.0, shift(random) - 8);
    for (const double near : {power, std::nextafter(power, 0.0), std::nextafter(power, 1e30),
                              0.5 * power, 0.999995 * power})
      check(near);
  }
  for (const double special :
       {0.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::max(),
        std::numeric_limits<double>::denorm_min()})
    check(special);
}

TEST(StampText, WritesTheLogsSixDecimals) {
  EXPECT_EQ(stamp_text(1'575'810'072'324'471'000), "1575810072.324471");
  EXPECT_EQ(stamp_text(21'019'900'000), "21.019900");
  EXPECT_EQ(stamp_text(0), "0.000000");
  EXPECT_EQ(stamp_text(-500'000'000), "-0.500000");
}

TEST(StampText, WritesNineDecimalsWhereSixWouldLoseSome) {
  EXPECT_EQ(stamp_text(1'123'456'789), "1.123456789");
}

TEST(FixedText, NeverWritesANegativeZero) {
  EXPECT_EQ(fixed_text(-0.0001, 3), "0.000");
  EXPECT_EQ(fixed_text(-0.1, 3), "-0.100");
  EXPECT_EQ(fixed_text(2.0, 0), "2");
  EXPECT_EQ(fixed_text(1e300, 1).size(), 303u);
}

TEST(FixedText, WritesWhatPrintfWrites) {
  for_many_numbers([](double value) {
    for (const int decimals : {0, 1, 3, 6, 9}) {
      std::string expected = printed("%.*f", decimals, value);
      if (expected.front() == '-' && expected.find_first_not_of("-0.") == std::string::npos)
        expected.erase(0, 1);
      ASSERT_EQ(fixed_text(value, decimals), expected) << decimals;
    }
  });
}

TEST(ShortText, WritesWhatPrintfWrites) {
  for_many_numbers([](double value) { ASSERT_EQ(short_text(value), printed("%.*g", 5, value)); });
}

}  // namespace
}  // namespace slammot::files
