#include "services/localization/published_covariance.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace slammot::localization {
namespace {

using geometry::Pose2;

Step step_with_sigma(double sigma_m) {
  Step step;
  step.duration_s = 0.1;
  step.source = StepSource::kOdometry;
  step.after.covariance.topLeftCorner<3, 3>() =
      Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, 1e-6).asDiagonal();
  return step;
}

ScanMatch match_at(double x_m, double sigma_m) {
  const geometry::Matrix3 covariance =
      Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, 1e-7).asDiagonal();
  return {.odom_from_base = {Pose2{x_m, 0.0, 0.0}, covariance},
          .is_believed = true,
          .rms_residual_m = 0.03};
}

double published_variance_m2(double surprise_m) {
  PublishedCovariance covariance{LocalizerConfig{}};
  const Step step = step_with_sigma(0.01);
  for (int scan = 0; scan < 50; ++scan) covariance.observe(step, match_at(surprise_m, 0.005));
  return covariance.published(step.after, false).odom_from_base.covariance(0, 0);
}

TEST(PublishedCovariance, GrowsWithTheSurprisesOfMatches) {
  EXPECT_GT(published_variance_m2(0.03), 2.0 * published_variance_m2(0.0));
}

TEST(PublishedCovariance, KeepsThePoseOfTheEstimate) {
  PublishedCovariance covariance{LocalizerConfig{}};
  sensing::MotionEstimate estimate;
  estimate.odom_from_base = {1.0, 2.0, 0.5};
  EXPECT_EQ(covariance.published(estimate, false).odom_from_base.pose, estimate.odom_from_base);
}

TEST(PublishedCovariance, IsThatOfTheFilterWhereNothingWasMatched) {
  PublishedCovariance covariance{LocalizerConfig{}};
  const Step step = step_with_sigma(0.5);  // all of it grown in this step
  covariance.observe(step, {.odom_from_base = step.prior()});
  EXPECT_NEAR(covariance.published(step.after, false).odom_from_base.covariance(0, 0), 0.25, 1e-9);
}

TEST(PublishedCovariance, IsLargerThanThatWithinTheLocalMapWhereScansAloneTell) {
  const LocalizerConfig config;
  PublishedCovariance with_wheels{config};
  PublishedCovariance without{config};
  const Step by_wheels = step_with_sigma(0.01);
  Step by_scans = by_wheels;
  by_scans.source = StepSource::kVelocityAlone;
  for (int scan = 0; scan < 100; ++scan) {
    with_wheels.observe(by_wheels, match_at(0.0, 0.005));
    without.observe(by_scans, match_at(0.0, 0.005));
  }
  const PublishedPose with = with_wheels.published(by_wheels.after, false);
  const PublishedPose alone = without.published(by_scans.after, false);
  EXPECT_EQ(with.local_variance_share, 1.0);
  EXPECT_NEAR(alone.local_variance_share, 1.0 / config.errors.variance_by_scans_alone, 1e-3);
  EXPECT_NEAR(alone.within_local_map().covariance(0, 0), with.within_local_map().covariance(0, 0),
              1e-9);
}

TEST(PublishedCovariance, CountsWheelsThatAreOverruledAsNone) {
  const LocalizerConfig config;
  PublishedCovariance covariance{config};
  Step step = step_with_sigma(0.01);
  step.source = StepSource::kVelocityAlone;
  step.wheels.are_overruled = true;
  for (int scan = 0; scan < 100; ++scan) covariance.observe(step, match_at(0.0, 0.005));
  EXPECT_NEAR(covariance.published(step.after, false).local_variance_share,
              1.0 / config.errors.variance_by_scans_alone, 1e-3);
}

TEST(PublishedCovariance, IsAnywhereOfALostVehicleButNotWithinTheLocalMap) {
  const LocalizerConfig config;
  const PublishedCovariance covariance{config};
  const Step step = step_with_sigma(0.1);
  const PublishedPose known = covariance.published(step.after, false);
  const PublishedPose lost = covariance.published(step.after, true);
  EXPECT_GT(std::sqrt(lost.odom_from_base.covariance(0, 0)), config.recovery.astray_sigma_m);
  EXPECT_GT(std::sqrt(lost.odom_from_base.covariance(2, 2)), 3.0);
  const auto position_m2 = [](const PublishedPose& pose) {
    return pose.within_local_map().covariance.topLeftCorner<2, 2>().trace();
  };
  EXPECT_NEAR(position_m2(lost), position_m2(known), 1e-9);
}

TEST(PublishedCovariance, GoesOnFromAStateAsBefore) {
  PublishedCovariance covariance{LocalizerConfig{}};
  const Step step = step_with_sigma(0.01);
  covariance.observe(step, match_at(0.02, 0.005));
  const auto state = covariance.state();
  const auto before = covariance.published(step.after, false).odom_from_base.covariance;
  covariance.observe(step, match_at(0.2, 0.005));
  EXPECT_NE(covariance.published(step.after, false).odom_from_base.covariance, before);
  covariance.set_state(state);
  EXPECT_EQ(covariance.published(step.after, false).odom_from_base.covariance, before);
}

}  // namespace
}  // namespace slammot::localization
