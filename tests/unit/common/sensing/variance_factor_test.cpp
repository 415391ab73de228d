#include "common/sensing/variance_factor.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace slammot::sensing {
namespace {

using geometry::UncertainPose2;

/// Factors after many matches whose errors are `true_sigma` times what prediction (variance 4) and
/// match (1) say.
VarianceFactors after_matches(double heading_rad, const Eigen::Vector3d& true_sigma_of_axis,
                              int matches) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 1.0);
  VarianceFactors factors;
  const Eigen::Vector3d unit(1e-4, 1e-4, 1e-6);
  for (int i = 0; i < matches; ++i) {
    const UncertainPose2 predicted{{10.0, -4.0, heading_rad}, (4.0 * unit).asDiagonal()};
    const Eigen::Vector3d change =
        std::sqrt(3.0) *
        unit.cwiseSqrt()
            .cwiseProduct(true_sigma_of_axis)
            .cwiseProduct(Eigen::Vector3d(noise(random), noise(random), noise(random)));
    const UncertainPose2 matched{
        predicted.pose * geometry::Pose2{change.x(), change.y(), change.z()}, unit.asDiagonal()};
    factors = learned(factors, predicted, matched, 0.01);
  }
  return factors;
}

TEST(VarianceFactors, StayAtOneWhereSurprisesAreAsExpected) {
  for (const double factor : after_matches(0.0, {1.0, 1.0, 1.0}, 3000).of_axis)
    EXPECT_NEAR(factor, 1.0, 0.25);
}

TEST(VarianceFactors, LearnForEachAxisOfTheVehicleHowFarOffTheFilterIs) {
  const Eigen::Vector3d factors = after_matches(1.0, {3.0, 0.5, 1.0}, 3000).of_axis;
  EXPECT_NEAR(factors.x(), 9.0, 2.5);
  EXPECT_NEAR(factors.y(), 0.25, 0.07);
  EXPECT_NEAR(factors.z(), 1.0, 0.25);
}

TEST(VarianceFactors, AreNotDrownedByOneWrongMatch) {
  const UncertainPose2 predicted{{}, Eigen::Vector3d(4e-4, 4e-4, 4e-6).asDiagonal()};
  const UncertainPose2 wrong{{5.0, 0.0, 0.0}, Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal()};
  EXPECT_LT(learned({}, predicted, wrong, 0.01).of_axis.x(), 1.3);
}

TEST(VarianceFactors, KeepWhatTheyKnowWhereTheMatchSaidNothing) {
  const UncertainPose2 predicted{{}, Eigen::Vector3d(4e-4, 4e-4, 4e-6).asDiagonal()};
  EXPECT_EQ(learned({.of_axis = {2.0, 3.0, 4.0}}, predicted, predicted, 0.5).of_axis,
            Eigen::Vector3d(2.0, 3.0, 4.0));
}

TEST(VarianceFactors, ScaleAlongAndAcrossTheVehicle) {
  const UncertainPose2 north{{0.0, 0.0, std::acos(-1.0) / 2.0},
                             Eigen::Vector3d(1.0, 1.0, 1.0).asDiagonal()};
  const geometry::Matrix3 covariance = scaled(north, {.of_axis = {9.0, 4.0, 1.0}});
  EXPECT_NEAR(covariance(0, 0), 4.0, 1e-12);
  EXPECT_NEAR(covariance(1, 1), 9.0, 1e-12);
  EXPECT_NEAR(covariance(0, 1), 0.0, 1e-12);
}

UncertainPose2 with_variances(double forward_m2, double left_m2, double heading_rad2) {
  return {{}, Eigen::Vector3d(forward_m2, left_m2, heading_rad2).asDiagonal()};
}

TEST(DeadReckonedShare, GrowsWhereTheMatchSaysNothingAndIsWornAwayWhereItDoes) {
  VarianceFactors factors;
  UncertainPose2 pose = with_variances(0.01, 0.01, 1e-4);
  for (int scan = 0; scan < 10; ++scan) {  // along a wall
    const UncertainPose2 predicted = with_variances(pose.covariance(0, 0) + 0.01, 0.02, 2e-4);
    const UncertainPose2 matched = with_variances(predicted.covariance(0, 0), 0.01, 1e-4);
    factors = carried(factors, pose, predicted, matched);
    pose = matched;
  }
  EXPECT_NEAR(factors.dead_reckoned.x(), 0.10 / 0.11, 1e-9);
  EXPECT_EQ(factors.dead_reckoned.y(), 0.0);
  EXPECT_EQ(factors.dead_reckoned.z(), 0.0);
  for (int scan = 0; scan < 10; ++scan) {  // its end in sight
    const UncertainPose2 predicted = with_variances(pose.covariance(0, 0) + 0.01, 0.02, 2e-4);
    const UncertainPose2 matched = with_variances(0.01, 0.01, 1e-4);
    factors = carried(factors, pose, predicted, matched);
    pose = matched;
  }
  EXPECT_LT(factors.dead_reckoned.x(), 0.01);
}

TEST(DeadReckonedShare, IsOfTheWayAheadOnlyWhereNothingIsMatched) {
  const UncertainPose2 predicted = with_variances(0.02, 0.02, 2e-4);
  const VarianceFactors factors =
      carried({}, with_variances(0.01, 0.01, 1e-4), predicted, predicted);
  EXPECT_NEAR(factors.dead_reckoned.x(), 0.5, 1e-12);
  EXPECT_EQ(factors.dead_reckoned.y(), 0.0);
  EXPECT_EQ(factors.dead_reckoned.z(), 0.0);
}

constexpr PoseErrors kErrors{.forward = {0.2, 2.0, 0.1, 8.0},
                             .sideways = {0.1, 1.0, 0.02, 2.0},
                             .heading = {0.3, 3.0, 0.03, 1.0}};
const VarianceFactors kSurprised{.of_axis = {0.01, 0.02, 0.03}};
const VarianceFactors kNotSurprised{.of_axis = Eigen::Vector3d::Zero()};

TEST(PublishedFactors, AreThoseOfEachScanWhereTheSameMapStaysInView) {
  EXPECT_TRUE(published(kSurprised, kErrors, {.way_m = 0.0})
                  .of_axis.isApprox(Eigen::Vector3d(0.2, 0.1, 0.3)));
}

TEST(PublishedFactors, GrowWithTheWayUntilAllThatIsInViewIsAnotherPartOfTheMap) {
  const Eigen::Vector3d of_scan(0.2, 0.1, 0.3);
  EXPECT_TRUE(
      published(kSurprised, kErrors, {.way_m = 8.0})
          .of_axis.isApprox(of_scan + Eigen::Vector3d(0.12 / 2.0, 0.04 * 0.8, 0.12 * 8.0 / 9.0)));
  EXPECT_TRUE(published(kSurprised, kErrors, {.way_m = 1e9})
                  .of_axis.isApprox(of_scan + Eigen::Vector3d(0.12, 0.04, 0.12), 1e-6));
}

TEST(PublishedFactors, GrowWithWhatTheMatchLeaves) {
  const Eigen::Vector3d well =
      published(kNotSurprised, kErrors, {.way_m = 3.0, .squared_residuals = 1.0}).of_axis;
  EXPECT_TRUE(published(kNotSurprised, kErrors, {.way_m = 3.0, .squared_residuals = 4.0})
                  .of_axis.isApprox(4.0 * well));
}

TEST(PublishedFactors, AreOneForWhatWasDeadReckoned) {
  const VarianceFactors factors{.of_axis = {0.01, 0.02, 0.03}, .dead_reckoned = {0.25, 1.0, 0.0}};
  EXPECT_TRUE(published(factors, kErrors, {})
                  .of_axis.isApprox(Eigen::Vector3d(0.75 * 0.2 + 0.25, 1.0, 0.3)));
}

}  // namespace
}  // namespace slammot::sensing
