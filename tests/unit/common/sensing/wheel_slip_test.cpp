#include "common/sensing/wheel_slip.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "common/sensing/odometry_belief.hpp"

namespace slammot::sensing {
namespace {

using geometry::Matrix3;
using geometry::Pose2;
using geometry::UncertainPose2;

constexpr double kSlipScanPeriod_s = 1.0 / 37.5;
const Eigen::Vector3d kStepSigma(0.006, 0.002, 0.001);
const Eigen::Vector3d kScanSigma(0.03, 0.03, 0.002);

/// A vehicle that drives a circle, its wheels and its scans.
class SlippingDrive {
 public:
  explicit SlippingDrive(unsigned seed) : random_(seed) {}

  const Pose2& truth() const { return truth_; }

  /// The step by wheels that count so much too much.
  UncertainPose2 step(double slip_mps) {
    const Pose2 moved{10.0 * kSlipScanPeriod_s, 0.0, 0.2 * kSlipScanPeriod_s};
    truth_ = truth_ * moved;
    const Eigen::Vector3d noise = drawn(kStepSigma);
    UncertainPose2 by_wheels;
    by_wheels.pose = {moved.x_m + slip_mps * kSlipScanPeriod_s + noise.x(), noise.y(),
                      moved.heading_rad + noise.z()};
    by_wheels.covariance = kStepSigma.cwiseAbs2().asDiagonal();
    return by_wheels;
  }

  /// The pose as a scan has it.
  Pose2 scan() {
    const Eigen::Vector3d noise = drawn(kScanSigma);
    return {truth_.x_m + noise.x(), truth_.y_m + noise.y(), truth_.heading_rad + noise.z()};
  }

 private:
  Eigen::Vector3d drawn(const Eigen::Vector3d& sigma) {
    return sigma.cwiseProduct(Eigen::Vector3d(unit_(random_), unit_(random_), unit_(random_)));
  }

  std::mt19937 random_;
  std::normal_distribution<double> unit_;
  Pose2 truth_;
};

const Matrix3 kScanInformation = kScanSigma.cwiseAbs2().cwiseInverse().asDiagonal();

UncertainPose2 corrected_by(const Pose2& scan, const UncertainPose2& prior) {
  UncertainPose2 match;
  match.covariance = (prior.covariance.inverse() + kScanInformation).inverse();
  const Eigen::Vector3d change =
      match.covariance * kScanInformation * geometry::difference(scan, prior.pose);
  match.pose = {prior.pose.x_m + change.x(), prior.pose.y_m + change.y(),
                prior.pose.heading_rad + change.z()};
  return match;
}

WheelSlip after_scan(WheelSlip slip, const Pose2& scan) {
  for (std::size_t i = 0; i < slip.size(); ++i) {
    slip[i].log_weight += log_marginal_likelihood(slip[i].odom_from_base, scan, kScanInformation);
    slip[i] = matched(slip[i], corrected_by(scan, slip[i].odom_from_base));
  }
  return slip.decided();
}

/// Drives with a slip for so long; changes of the wheels' speed were found one step late.
WheelSlip drive_on(WheelSlip slip, SlippingDrive& drive, double slip_mps, double duration_s) {
  for (double time_s = 0.0; time_s < duration_s && slip.is_active(); time_s += kSlipScanPeriod_s) {
    slip = slip.moved(drive.step(slip_mps), kSlipScanPeriod_s);
    slip = after_scan(slip, drive.scan());
  }
  return slip;
}

UncertainPose2 known(const Pose2& pose) {
  UncertainPose2 at{pose, Matrix3::Zero()};
  at.covariance.diagonal() << 1e-4, 1e-4, 1e-6;
  return at;
}

TEST(WheelSlip, IsFoundWithItsSpeed) {
  for (const double slip_mps : {0.7, 1.0, -1.0, 3.0}) {
    SlippingDrive drive(5);
    WheelSlip slip = WheelSlip().changed(known(drive.truth()), 0.8 * slip_mps, 0.05);
    EXPECT_EQ(slip.size(), 2U);
    slip = drive_on(slip, drive, slip_mps, 3.0);
    ASSERT_EQ(slip.size(), 1U) << slip_mps;
    EXPECT_NEAR(slip[0].slip_mps, slip_mps, 0.25);
    EXPECT_NEAR(slip[0].odom_from_base.pose.x_m, drive.truth().x_m, 0.06);
    EXPECT_FALSE(slip.keeps_map_as_it_is());
  }
}

TEST(WheelSlip, IsNoneWhereTheVehicleChangedItsSpeed) {
  SlippingDrive drive(6);
  WheelSlip slip = WheelSlip().changed(known(drive.truth()), 1.0, 0.05);
  EXPECT_TRUE(slip.keeps_map_as_it_is());
  EXPECT_FALSE(drive_on(slip, drive, 0.0, 1.0).is_active());
}

TEST(WheelSlip, EndsWhenTheWheelsChangeBack) {
  SlippingDrive drive(7);
  WheelSlip slip = drive_on(WheelSlip().changed(known(drive.truth()), 1.0, 0.05), drive, 1.0, 3.0);
  ASSERT_TRUE(slip.is_active());
  slip = slip.changed(slip[0].odom_from_base, -0.9, 0.05);
  EXPECT_EQ(slip.size(), 3U) << "goes on, is smaller, or is over";
  EXPECT_FALSE(drive_on(slip, drive, 0.0, 1.5).is_active());
}

TEST(WheelSlip, ThatEndsUnnoticedIsQuestionedAndEnds) {
  SlippingDrive drive(8);
  WheelSlip slip = drive_on(WheelSlip().changed(known(drive.truth()), 1.0, 0.05), drive, 1.0, 3.0);
  ASSERT_TRUE(slip.is_active());
  EXPECT_FALSE(drive_on(slip, drive, 0.0, 12.0).is_active());
}

TEST(WheelSlip, ThatNoScanTellsOfBeginsWithEvenOdds) {
  SlippingDrive drive(9);
  WheelSlip slip = WheelSlip().changed(known(drive.truth()), 1.0, 0.05);
  for (int step = 0; step < 10; ++step) slip = slip.moved(drive.step(1.0), kSlipScanPeriod_s);
  EXPECT_EQ(slip[0].log_weight, slip[1].log_weight);
  EXPECT_LT(slip[0].odom_from_base.covariance(0, 0), slip[1].odom_from_base.covariance(0, 0));
}

/// Normalized squared error of (pose, slip): 4 on average if the covariance is honest.
double squared_error(const SlipHypothesis& estimate, const Pose2& truth, double slip_mps) {
  Eigen::Vector4d error;
  error << geometry::difference(truth, estimate.odom_from_base.pose), slip_mps - estimate.slip_mps;
  Eigen::Matrix4d covariance;
  covariance << estimate.odom_from_base.covariance, estimate.pose_with_slip,
      estimate.pose_with_slip.transpose(), estimate.slip_variance;
  return error.dot(covariance.inverse() * error);
}

TEST(WheelSlip, KnowsHowWellItIsKnown) {
  constexpr int kDrives = 200;
  double sum = 0.0;
  for (unsigned seed = 0; seed < kDrives; ++seed) {
    SlippingDrive drive(seed);
    std::mt19937 random(1000 + seed);
    std::normal_distribution<double> unit;
    const UncertainPose2 start = known(drive.truth());
    SlipHypothesis estimate{.odom_from_base = start,
                            .pose_with_slip = Eigen::Vector3d::Zero(),
                            .slip_mps = 1.0,
                            .slip_variance = 0.09,
                            .log_weight = 0.0};
    estimate.odom_from_base.pose.x_m += 0.01 * unit(random);
    estimate.odom_from_base.pose.y_m += 0.01 * unit(random);
    estimate.odom_from_base.pose.heading_rad += 0.001 * unit(random);
    double slip_mps = 1.0 + 0.3 * unit(random);
    for (int scan = 0; scan < 40; ++scan) {
      estimate = moved(estimate, drive.step(slip_mps), kSlipScanPeriod_s);
      slip_mps += 0.2 * std::sqrt(kSlipScanPeriod_s) * unit(random);
      estimate = matched(estimate, corrected_by(drive.scan(), estimate.odom_from_base));
    }
    sum += squared_error(estimate, drive.truth(), slip_mps);
  }
  EXPECT_NEAR(sum / kDrives, 4.0, 0.6);  // three sigmas of the mean of 200 are 0.6
}

TEST(WheelSlip, KnowsAStateThatCannotBe) {
  WheelSlip slip = WheelSlip().changed(known({}), 1.0, 0.05);
  EXPECT_TRUE(slip.is_sound());
  slip[1].slip_variance = -1.0;
  EXPECT_FALSE(slip.is_sound());
  slip[1].slip_variance = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(slip.is_sound());
}

}  // namespace
}  // namespace slammot::sensing
