#include "common/app/input_watch.hpp"

#include <gtest/gtest.h>

namespace slammot::app {
namespace {

using namespace std::chrono_literals;

const SteadyTime kStart{100s};

TEST(InputWatch, MissesASteadyInputThatNeverCame) {
  const InputWatch watch("slammot/laser_scan", Input::kSteady, kStart);
  EXPECT_FALSE(watch.is_missing(kStart + 2s, 2s));
  EXPECT_TRUE(watch.is_missing(kStart + 2001ms, 2s));
  EXPECT_EQ(watch.complaint(kStart + 3s), "no slammot/laser_scan yet");
  EXPECT_LT(watch.silent_s(kStart + 3s), 0.0);
}

TEST(InputWatch, MissesASteadyInputThatFellSilent) {
  InputWatch watch("slammot/laser_scan", Input::kSteady, kStart);
  watch.came(kStart + 10s);
  EXPECT_FALSE(watch.is_missing(kStart + 12s, 2s));
  EXPECT_TRUE(watch.is_missing(kStart + 12100ms, 2s));
  EXPECT_EQ(watch.complaint(kStart + 12100ms), "no slammot/laser_scan for 2.1 s");
}

TEST(InputWatch, NeverMissesAnOccasionalInput) {
  const InputWatch watch("slammot/submap_tile", Input::kOccasional, kStart);
  EXPECT_FALSE(watch.is_missing(kStart + 1h, 2s));
}

}  // namespace
}  // namespace slammot::app
