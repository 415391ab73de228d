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

}  // namespace
}  // namespace slammot
