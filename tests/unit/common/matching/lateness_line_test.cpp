#include "common/matching/lateness_line.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace slammot::matching {
namespace {

/// Of a number of measurements spread over the time, each of this sigma and limited like pairs.
double error_of_line(double late_s, double change_s, double true_late_s, double true_change_s,
                     double sigma_s) {
  double error = 0.0;
  for (int i = 0; i <= 20; ++i) {
    const double share = 0.05 * i - 0.5;
    const double difference_s = late_s - true_late_s + share * (change_s - true_change_s);
    error += std::min(9.0, difference_s * difference_s / (sigma_s * sigma_s));
  }
  return error;
}

TEST(LatenessLine, IsFoundWithItsSigma) {
  const auto line = best_lateness_line(
      [](double late_s, double change_s) {
        return error_of_line(late_s, change_s, 0.06, 0.1, 0.02);
      },
      0.0, 0.4);
  ASSERT_TRUE(line);
  EXPECT_NEAR(line->late_s, 0.06, 0.002);
  EXPECT_NEAR(line->change_s, 0.1, 0.004);
  EXPECT_LT(line->error, 0.2);
  EXPECT_GT(line->error_without_change, 20.0);
  EXPECT_NEAR(line->sigma_change_s, 0.0144, 0.004);
}

TEST(LatenessLine, HasTheSameErrorWithoutChangeWhereThereIsNone) {
  const auto line = best_lateness_line(
      [](double late_s, double change_s) {
        return error_of_line(late_s, change_s, 0.3, 0.0, 0.02);
      },
      0.25, 0.4);
  ASSERT_TRUE(line);
  EXPECT_NEAR(line->change_s, 0.0, 0.004);
  EXPECT_NEAR(line->error, line->error_without_change, 0.1);
}

TEST(LatenessLine, IsNoneBeyondWhatIsSearchedOrWhereNothingTells) {
  EXPECT_FALSE(best_lateness_line(
      [](double late_s, double change_s) { return error_of_line(late_s, change_s, 0.0, 0.9, 0.2); },
      0.0, 0.4));
  EXPECT_FALSE(best_lateness_line([](double, double) { return 7.0; }, 0.0, 0.4));
}

}  // namespace
}  // namespace slammot::matching
