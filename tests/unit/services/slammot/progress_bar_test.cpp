#include "services/slammot/progress_bar.hpp"

#include <gtest/gtest.h>

namespace slammot {
namespace {

TEST(BarText, FillsWithProgressAndStaysInItsWidth) {
  EXPECT_EQ(bar_text(0.0, 4), "[>   ]   0 %");
  EXPECT_EQ(bar_text(0.5, 4), "[==> ]  50 %");
  EXPECT_EQ(bar_text(1.0, 4), "[====] 100 %");
  EXPECT_EQ(bar_text(7.0, 4), "[====] 100 %");
  EXPECT_EQ(bar_text(-1.0, 4), "[>   ]   0 %");
}

TEST(PaceText, EstimatesTheTimeLeftFromTheFractionDone) {
  EXPECT_EQ(pace_text(0.5, 100.0, 8.0), "12.5x real time, 8 s left");
  EXPECT_EQ(pace_text(1.0, 100.0, 8.0), "12.5x real time, 0 s left");
}

TEST(PaceText, StatesNoTimeLeftBeforeItCanBeKnown) {
  EXPECT_EQ(pace_text(0.0, 1.0, 0.5), "2.0x real time");
}

}  // namespace
}  // namespace slammot
