#include "services/localization/sweep_correction.hpp"

#include <gtest/gtest.h>

namespace slammot::localization {
namespace {

sensing::LaserScan sweeping_scan() {
  sensing::LaserScan scan;
  scan.scanner.sweep_s = 0.08;
  scan.range_m = {1.0F, 2.0F};
  return scan;
}

SweepCorrection correction(double sigma, double value = 1.0) {
  LocalizerConfig config;
  config.echoes.sweep_factor_sigma = sigma;
  SweepCorrection correction(config);
  SweepFactor factor = correction.factor();
  factor.value = value;
  correction.set_factor(factor);
  return correction;
}

TEST(SweepCorrection, TakesTheScannersWordUnlessItIsToLearn) {
  SweepCorrection right = correction(0.0, -1.0);
  const sensing::LaserScan scan = sweeping_scan();
  EXPECT_EQ(right.sweep_s(scan), 0.08);
  EXPECT_EQ(&right.corrected(scan), &scan);
}

TEST(SweepCorrection, AppliesTheFactorAsEstimated) {
  SweepCorrection reversed = correction(1.0, -1.0);
  EXPECT_DOUBLE_EQ(reversed.corrected(sweeping_scan()).scanner.sweep_s, -0.08);
  EXPECT_EQ(reversed.corrected(sweeping_scan()).range_m, sweeping_scan().range_m);
}

TEST(SweepCorrection, LearnsNothingFromAMatchThatIsNotBelieved) {
  SweepCorrection learning = correction(1.0);
  const ScanPoints points{LocalizerConfig{}};
  Step step;
  step.duration_s = 0.1;
  step.after.covariance.setIdentity();
  learning.observe(sweeping_scan(), step, points, {}, grids::SurfelMap{});
  EXPECT_FALSE(learning.factor().mapped_motion);
  learning.observe(sweeping_scan(), step, points, {.odom_from_base = {}, .is_believed = true},
                   grids::SurfelMap{});
  EXPECT_TRUE(learning.factor().mapped_motion);
}

TEST(SweepCorrection, LearnsNothingFromAScanWithoutSweep) {
  SweepCorrection learning = correction(1.0);
  const ScanPoints points{LocalizerConfig{}};
  Step step;
  step.duration_s = 0.1;
  step.after.covariance.setIdentity();
  sensing::LaserScan at_once = sweeping_scan();
  at_once.scanner.sweep_s = 0.0;
  learning.observe(at_once, step, points, {.odom_from_base = {}, .is_believed = true},
                   grids::SurfelMap{});
  EXPECT_FALSE(learning.factor().mapped_motion);
  EXPECT_EQ(&learning.corrected(at_once), &at_once);
}

}  // namespace
}  // namespace slammot::localization
