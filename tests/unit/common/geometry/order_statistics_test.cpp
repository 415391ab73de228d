#include "common/geometry/order_statistics.hpp"

#include <cstdint>

#include <gtest/gtest.h>

namespace slammot::geometry {
namespace {

TEST(UpperMedian, IsTheMiddleValueOfAnOddCount) {
  EXPECT_EQ(upper_median(std::vector{5.0, -1.0, 3.0}), 3.0);
  EXPECT_EQ(upper_median(std::vector<std::int64_t>{7}), 7);
}

TEST(UpperMedian, IsTheGreaterOfTheTwoInTheMiddleOfAnEvenCount) {
  EXPECT_EQ(upper_median(std::vector{4.0F, 1.0F, 3.0F, 2.0F}), 3.0F);
  EXPECT_EQ(upper_median(std::vector{2.0, 1.0}), 2.0);
}

TEST(UpperMedian, IsZeroOfNone) {
  EXPECT_EQ(upper_median(std::vector<double>{}), 0.0);
  EXPECT_EQ(upper_median(std::vector<std::int64_t>{}), 0);
}

TEST(UpperMedian, LeavesTheValuesInTheirOrder) {
  const std::vector values{9.0, 2.0, 7.0, 1.0, 8.0};
  std::vector<double> given = values;
  EXPECT_EQ(upper_median(given), 7.0);
  EXPECT_EQ(given, values);
  EXPECT_EQ(upper_median_in_place(given), 7.0);
}

TEST(LowerQuantile, RoundsTheRankDown) {
  const std::vector values{40.0, 10.0, 30.0, 20.0};
  EXPECT_EQ(lower_quantile(values, 0.0), 10.0);
  EXPECT_EQ(lower_quantile(values, 0.5), 20.0);
  EXPECT_EQ(lower_quantile(values, 0.9), 30.0);
  EXPECT_EQ(lower_quantile(values, 1.0), 40.0);
}

TEST(LowerQuantile, IsZeroOfNone) { EXPECT_EQ(lower_quantile({}, 0.5), 0.0); }

}  // namespace
}  // namespace slammot::geometry
