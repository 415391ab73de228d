#include "common/sensing/stamp_guard.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace slammot::sensing {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

TEST(StampGuard, BelievesWhatComesInTimeOrLate) {
  StampGuard guard(60.0);
  for (const std::int64_t stamp_s : {1000, 1001, 1000, 1060, 900})
    EXPECT_TRUE(guard.believes(stamp_s * kSecond)) << stamp_s;
}

TEST(StampGuard, DoesNotBelieveASingleOneHoweverOftenItIsRepeated) {
  StampGuard guard(60.0);
  EXPECT_TRUE(guard.believes(1000 * kSecond));
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(guard.believes(5000 * kSecond));
  EXPECT_FALSE(guard.believes(std::numeric_limits<std::int64_t>::max()));
  EXPECT_TRUE(guard.believes(1001 * kSecond));
  EXPECT_FALSE(guard.believes(5000 * kSecond));  // what it agreed with is long forgotten
}

TEST(StampGuard, BelievesTheSecondOfTwoThatAgreeAfterAGap) {
  StampGuard guard(60.0);
  EXPECT_TRUE(guard.believes(1000 * kSecond));
  EXPECT_FALSE(guard.believes(5000 * kSecond));
  EXPECT_TRUE(guard.believes(5001 * kSecond));
  EXPECT_TRUE(guard.believes(5002 * kSecond));
}

}  // namespace
}  // namespace slammot::sensing
