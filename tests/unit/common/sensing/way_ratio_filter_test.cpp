#include "common/sensing/way_ratio_filter.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace slammot::sensing {
namespace {

/// A comparison in which ways of these ratios fit.
WayRatioFilter::Profile peaks_at(std::initializer_list<double> ratios) {
  WayRatioFilter::Profile profile{};
  for (std::size_t i = 0; i < profile.size(); ++i) {
    for (const double ratio : ratios)
      profile[i] += 3.0 * std::exp(-0.5 * std::pow((WayRatioFilter::kRatios[i] - ratio) / 0.05, 2));
  }
  return profile;
}

TEST(WayRatioFilter, BelievesOdometryThatFits) {
  WayRatioFilter filter;
  for (int i = 0; i < 20; ++i) filter.update(peaks_at({1.0}));
  EXPECT_GT(filter.sound_probability(), 0.95);
}

TEST(WayRatioFilter, DoubtsWheelsThatSlipWithinAFewComparisons) {
  WayRatioFilter filter;
  for (int i = 0; i < 20; ++i) filter.update(peaks_at({1.0}));
  for (int i = 0; i < 4; ++i) filter.update(peaks_at({0.85}));
  EXPECT_LT(filter.sound_probability(), 0.05);
  EXPECT_DOUBLE_EQ(filter.most_likely_ratio(), 0.85);
}

TEST(WayRatioFilter, TakesTheRatioThatAllComparisonsHaveInCommon) {
  WayRatioFilter filter;
  for (const double other : {0.5, 1.3, 0.7, 1.15, 1.0}) filter.update(peaks_at({0.85, other}));
  EXPECT_DOUBLE_EQ(filter.most_likely_ratio(), 0.85);
}

TEST(WayRatioFilter, BelievesOdometryAgainAfterTheSlip) {
  WayRatioFilter filter;
  for (int i = 0; i < 20; ++i) filter.update(peaks_at({0.85}));
  for (int i = 0; i < 4; ++i) filter.update(peaks_at({1.0}));
  EXPECT_GT(filter.sound_probability(), 0.95);
}

TEST(WayRatioFilter, DecidesByOneComparisonOnceInDoubt) {
  for (const double ratio : {0.85, 1.0}) {
    WayRatioFilter filter;
    for (int i = 0; i < 20; ++i) filter.update(peaks_at({1.0}));
    filter.doubt();
    EXPECT_TRUE(filter.is_sound());
    EXPECT_NEAR(filter.sound_probability(), 0.5, 0.05);
    filter.update(peaks_at({ratio}));
    EXPECT_DOUBLE_EQ(filter.most_likely_ratio(), ratio);
  }
}

TEST(WayRatioFilter, LearnsNothingWhereNoRatioStandsOut) {
  WayRatioFilter::Profile slope;
  for (std::size_t i = 0; i < slope.size(); ++i)
    slope[i] = 0.8 - 0.2 * WayRatioFilter::kRatios[i] + (i % 2 == 0 ? 0.01 : -0.01);
  for (const double value : WayRatioFilter::prominent(slope, 0.06)) EXPECT_EQ(value, 0.0);
  slope[3] += 0.2;
  EXPECT_GT(WayRatioFilter::prominent(slope, 0.06)[3], 0.1);
}

/// Fits in a tunnel, between traffic that moves along: best with no way at all.
WayRatioFilter::Profile fits_beside_traffic() {
  WayRatioFilter::Profile fits;
  for (std::size_t i = 0; i < fits.size(); ++i)
    fits[i] = 0.42 + 0.15 * std::exp(-WayRatioFilter::kRatios[i] / 0.3);
  return fits;
}

TEST(WayRatioFilter, LearnsNothingFromTrafficThatMovesAlong) {
  for (const double value : WayRatioFilter::prominent(fits_beside_traffic(), 0.01))
    EXPECT_EQ(value, 0.0);
}

TEST(WayRatioFilter, DoesNotTakeTheBendOfTheTrendForTheLargestRatio) {
  WayRatioFilter::Profile fits = fits_beside_traffic();
  fits.front() -= 0.04;
  fits.back() += 0.03;
  for (const double value : WayRatioFilter::prominent(fits, 0.025)) EXPECT_EQ(value, 0.0);
  fits.back() += 0.2;
  EXPECT_GT(WayRatioFilter::prominent(fits, 0.025).back(), 0.1);
}

}  // namespace
}  // namespace slammot::sensing
