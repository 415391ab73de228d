#include "common/app/log.hpp"

#include <gtest/gtest.h>

namespace slammot::app {
namespace {

using namespace std::chrono_literals;

const std::chrono::steady_clock::time_point kStart{100s};

TEST(RateLimit, LetsTheFirstLineThrough) {
  EXPECT_EQ(RateLimit{}.pass("bad scan", "scan 7 is bad", kStart), "scan 7 is bad");
}

TEST(RateLimit, HoldsBackWhatFollowsAndSaysLaterHowMuchItWas) {
  RateLimit limit;
  limit.pass("bad scan", "scan 7 is bad", kStart);
  EXPECT_EQ(limit.pass("bad scan", "scan 8 is bad", kStart + 1s), "");
  EXPECT_EQ(limit.pass("bad scan", "scan 9 is bad", kStart + 4999ms), "");
  EXPECT_EQ(limit.pass("bad scan", "scan 10 is bad", kStart + 5s),
            "scan 10 is bad (and 2 more like it)");
  EXPECT_EQ(limit.pass("bad scan", "scan 11 is bad", kStart + 10s), "scan 11 is bad");
}

TEST(RateLimit, KeepsKindsApart) {
  RateLimit limit;
  limit.pass("bad scan", "scan 7 is bad", kStart);
  EXPECT_EQ(limit.pass("bad tile", "tile 7 is bad", kStart), "tile 7 is bad");
}

}  // namespace
}  // namespace slammot::app
