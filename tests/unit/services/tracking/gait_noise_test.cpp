#include "services/tracking/gait_noise.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/example_tracks.hpp"

namespace slammot::tracking {
namespace {

using testing::kPeriodS;

/// What is learned of one who is always so far from where they were predicted.
double sigma_after_m(double innovation_m, const TrackingConfig& config) {
  const Eigen::Matrix2d noise_m2 = 1e-4 * Eigen::Matrix2d::Identity();
  GaitNoise gait;
  for (int scan = 0; scan < 250; ++scan)
    gait = with_step(gait, {innovation_m, innovation_m}, noise_m2, kPeriodS, config);
  return std::sqrt(*gait.variance_m2);
}

/// Variance of the mean of `count` errors, of which each keeps so much of the one before; one sigma
/// is 1.
double variance_of_mean(double kept, int count) {
  double sum = 0.0;
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) sum += std::pow(kept, std::abs(i - j));
  return sum / (count * count);
}

TEST(GaitNoise, IsThatOfLegsUntilLessOrMoreIsSeen) {
  const TrackingConfig config;
  EXPECT_NEAR(sigma_after_m(0.07, config), 0.07, 0.01);
  EXPECT_NEAR(sigma_after_m(0.0, config), std::sqrt(0.125) * gait_sigma_m(config), 1e-12);
  EXPECT_NEAR(sigma_after_m(0.2, config), 0.2, 0.01);
  EXPECT_NEAR(sigma_after_m(1.0, config), 3.0 * gait_sigma_m(config), 1e-12) << "nobody who walks";
}

TEST(GaitNoise, IsNeverLessThanThatOfLegsWhereOnlyPeopleMove) {
  TrackingConfig config;
  config.extent.longest_body_m = 2.0;
  EXPECT_NEAR(sigma_after_m(0.0, config), gait_sigma_m(config), 1e-12);
  EXPECT_NEAR(sigma_after_m(0.2, config), 0.2, 0.01);
}

TEST(GaitNoise, CountsForAsMuchAsErrorsThatFadeDoTogether) {
  const TrackingConfig config;
  for (const double period_s : {1.0 / 75.0, 1.0 / 37.5, 1.0 / 7.5, 0.5}) {
    const int count = static_cast<int>(std::lround(10.0 / period_s));
    const double together_m2 = gait_sigma_m(config) * gait_sigma_m(config) *
                               variance_of_mean(std::exp(-period_s / kGaitMemoryS), count);
    EXPECT_NEAR(gait_variance_m2(period_s, config) / count / together_m2, 1.0, 0.03) << period_s;
  }
}

}  // namespace
}  // namespace slammot::tracking
