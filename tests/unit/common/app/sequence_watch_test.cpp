#include "common/app/sequence_watch.hpp"

#include <gtest/gtest.h>

namespace slammot::app {
namespace {

TEST(SequenceWatch, CountsTheNumbersBetweenTwoScansOfOneScanner) {
  SequenceWatch watch;
  EXPECT_EQ(watch.missed_before("front", 700), 0U);  // joined late
  EXPECT_EQ(watch.missed_before("front", 701), 0U);
  EXPECT_EQ(watch.missed_before("rear", 5), 0U);
  EXPECT_EQ(watch.missed_before("front", 705), 3U);
  EXPECT_EQ(watch.missed_before("rear", 6), 0U);
}

TEST(SequenceWatch, BeginsAnewWithARestartedSourceAndIgnoresRepeatedScans) {
  SequenceWatch watch;
  watch.missed_before("front", 700);
  EXPECT_EQ(watch.missed_before("front", 700), 0U);
  EXPECT_EQ(watch.missed_before("front", 0), 0U);
  EXPECT_EQ(watch.missed_before("front", 2), 1U);
}

TEST(SequenceWatch, ForgetsScannersRatherThanGrowForEver) {
  SequenceWatch watch;
  for (int i = 0; i < 100'000; ++i)
    EXPECT_EQ(watch.missed_before(std::to_string(i).c_str(), 1), 0U);
}

}  // namespace
}  // namespace slammot::app
