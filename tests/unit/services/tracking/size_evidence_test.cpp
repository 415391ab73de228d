#include "services/tracking/size_evidence.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace slammot::tracking {
namespace {

TEST(SizeEvidence, IsAtLeastAsLargeAsTheFirstPartAndGrowsSlowlyAfterwards) {
  SizeEvidence evidence;
  add_part(evidence, 2.0);
  EXPECT_EQ(evidence.least_m, 2.0);
  add_part(evidence, 4.0);
  EXPECT_GT(evidence.least_m, 2.0);
  EXPECT_LT(evidence.least_m, 3.0) << "one scan may be wrong";
  const double before_m = evidence.least_m;
  add_part(evidence, 1.0);
  EXPECT_EQ(evidence.least_m, before_m);
}

TEST(SizeEvidence, FusesMeasurementsFromEdgeToEdgeDownToTheirCommonError) {
  SizeEvidence evidence;
  add_whole(evidence, {4.6, 0.04, 0.0}, 1.0);
  EXPECT_NEAR(evidence.whole.value_m, 4.6, 1e-3);
  const double once_m2 = evidence.whole.variance_m2;
  for (int scan = 0; scan < 100; ++scan) add_whole(evidence, {4.6, 0.04, 0.0}, 1.0);
  EXPECT_LT(evidence.whole.variance_m2, once_m2);
  EXPECT_NEAR(evidence.whole.variance_m2, 0.25 * 0.04, 1e-9)
      << "errors of neighbouring scans are correlated";
}

TEST(SizeEvidence, IgnoresAPieceAndForgetsTheLowerBoundThatItContradicts) {
  SizeEvidence evidence;
  add_part(evidence, 6.0);
  add_whole(evidence, {4.5, 0.01, 0.0}, 1.0);
  EXPECT_EQ(evidence.whole.variance_m2, kUnknownSizeM2);
  EXPECT_LT(evidence.least_m, 6.0);
  for (int scan = 0; scan < 200; ++scan) add_whole(evidence, {4.5, 0.01, 0.0}, 1.0);
  EXPECT_NEAR(evidence.whole.value_m, 4.5, 1e-3);
}

TEST(SizeEvidence, IsCompletedByWhatCornersHide) {
  const SizeEvidence evidence = with_corners({0.0, {4.4, 0.01}, 0.5}, {0.2, 0.0004});
  EXPECT_NEAR(evidence.whole.value_m, 4.5, 1e-12);
  EXPECT_GT(evidence.whole.variance_m2, 0.01);
}

TEST(SizeEvidence, IsLikelierForTheKindThatItFits) {
  const SizeEvidence evidence{4.2, {4.4, 0.01}};
  EXPECT_GT(log_likelihood_of_size(4.4, 0.4, evidence, 1.0),
            log_likelihood_of_size(7.0, 1.2, evidence, 1.0));
  EXPECT_LT(log_likelihood_of_size(1.75, 0.2, {4.2, {0.0, kUnknownSizeM2}}, 1.0),
            log_likelihood_of_size(4.4, 0.4, {4.2, {0.0, kUnknownSizeM2}}, 1.0))
      << "the lower bound alone";
}

TEST(SizeFit, IsThePriorWithoutEvidenceAndTheMeasurementWithAPreciseOne) {
  const SizeFit prior = size_fit(4.4, 0.4, {}, 1.0, -4.0);
  EXPECT_NEAR(prior.size.value_m, 4.4, 1e-3);
  EXPECT_NEAR(prior.size.variance_m2, 0.16, 1e-3);
  const SizeFit measured = size_fit(4.4, 0.4, {4.7, {4.8, 0.0001}}, 1.0, -4.0);
  EXPECT_NEAR(measured.size.value_m, 4.8, 0.01);
}

TEST(SizeFit, TakesAMeasurementFarBelowThePriorForAPiece) {
  const SizeFit fit = size_fit(12.0, 1.2, {6.0, {6.5, 0.01}}, 1.0, -4.0);
  EXPECT_NEAR(fit.size.value_m, 12.0, 0.1);
}

TEST(LogSum, IsTheLogarithmOfASumWithoutOverflow) {
  EXPECT_NEAR(log_sum(std::log(2.0), std::log(3.0)), std::log(5.0), 1e-12);
  EXPECT_NEAR(log_sum(1000.0, 1000.0), 1000.0 + std::log(2.0), 1e-9);
  EXPECT_EQ(log_sum(-1e300, 0.0), 0.0);
}

}  // namespace
}  // namespace slammot::tracking
