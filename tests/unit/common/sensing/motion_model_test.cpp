#include "common/sensing/motion_model.hpp"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "tests/support/matchers.hpp"
#include "tests/support/synthetic_world.hpp"

namespace slammot::sensing {
namespace {

using geometry::Pose2;
using slammot::testing::arc;
using slammot::testing::PoseNear;
using slammot::testing::step_by_wheels;
using slammot::testing::WheelErrors;

constexpr double kStep_s = 0.1;
constexpr int kSpeed = kMotionStates - 2;  // row in the covariance
const MotionModelConfig kConfig;

/// What a match whose own answer is `measured` makes of the prediction: product of the two
/// Gaussians.
geometry::UncertainPose2 fused(const geometry::UncertainPose2& prior,
                               const geometry::UncertainPose2& measured) {
  const Eigen::Matrix3d gain =
      prior.covariance * (prior.covariance + measured.covariance).inverse();
  const Eigen::Vector3d difference(
      measured.pose.x_m - prior.pose.x_m, measured.pose.y_m - prior.pose.y_m,
      geometry::wrap_angle(measured.pose.heading_rad - prior.pose.heading_rad));
  const Eigen::Vector3d change = gain * difference;
  return {{prior.pose.x_m + change.x(), prior.pose.y_m + change.y(),
           prior.pose.heading_rad + change.z()},
          (Eigen::Matrix3d::Identity() - gain) * prior.covariance};
}

struct Laser {
  double position_sigma_m = 0.02;
  double heading_sigma_rad = 0.001;
};

/// A drive whose steps are `truth(i)`, by wheels with errors and by a laser that sees the pose in a
/// known map.
template <typename Truth>
MotionEstimate after_driving(int steps, const WheelErrors& errors, const Truth& truth,
                             const Laser& laser = {}, unsigned seed = 3) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 1.0);
  MotionEstimate estimate = at_start(kConfig);
  Pose2 odom_from_base;
  const Eigen::Vector3d sigmas(laser.position_sigma_m, laser.position_sigma_m,
                               laser.heading_sigma_rad);
  for (int i = 0; i < steps; ++i) {
    const Pose2 step = truth(i);
    odom_from_base = odom_from_base * step;
    estimate = moved_by_wheels(estimate, {step_by_wheels(step, kStep_s, errors), kStep_s}, kConfig);
    const Pose2 seen{odom_from_base.x_m + sigmas.x() * noise(random),
                     odom_from_base.y_m + sigmas.y() * noise(random),
                     odom_from_base.heading_rad + sigmas.z() * noise(random)};
    estimate = matched(estimate,
                       fused(estimate.uncertain_pose(), {seen, sigmas.cwiseAbs2().asDiagonal()}));
  }
  return estimate;
}

Pose2 winding_street(int i) { return arc({}, 8.0, 0.3 * std::sin(0.05 * i))(kStep_s); }
Pose2 stop_and_go(int i) { return arc({}, i % 100 < 50 ? 0.5 : 10.0, 0.0)(kStep_s); }

TEST(MotionEstimate, BeginsAtThePrior) {
  const MotionEstimate estimate = at_start(kConfig);
  EXPECT_EQ(estimate.scale(), 1.0);
  EXPECT_THAT(estimate.odom_from_base, PoseNear(Pose2{}, 1e-15));
  EXPECT_EQ((estimate.covariance.topLeftCorner<3, 3>().norm()), 0.0);
  EXPECT_DOUBLE_EQ(std::sqrt(estimate.covariance(3, 3)), kConfig.scale_prior);
  EXPECT_DOUBLE_EQ(std::sqrt(estimate.covariance(4, 4)), kConfig.heading_rate_bias_prior_radps);
  EXPECT_DOUBLE_EQ(std::sqrt(estimate.covariance(5, 5)), kConfig.heading_per_metre_bias_prior);
}

TEST(MotionEstimate, LearnsAScaleThatIsOnePercentOff) {
  for (const double scale : {0.99, 1.01})
    EXPECT_NEAR(after_driving(300, {.scale = scale}, winding_street).scale(), scale, 0.0005);
}

TEST(MotionEstimate, LearnsTheScaleFromALaserThatIsFarLessSureThanASingleStep) {
  // 0.3 m a match against 8 mm by which each step is short: only all the steps together show it.
  EXPECT_NEAR(
      after_driving(600, {.scale = 1.01}, winding_street, {.position_sigma_m = 0.3}).scale(), 1.01,
      0.003);
}

TEST(MotionEstimate, LearnsTheTurnThatABiasedGyroMisses) {
  const double bias_radps = 0.003;
  const MotionEstimate estimate = after_driving(600, {.heading_rate_bias_radps = bias_radps},
                                                [](int) { return arc({}, 2.0, 0.1)(kStep_s); });
  // At one speed a bias by time and one by distance are the same thing: only their sum can be
  // known.
  EXPECT_NEAR(estimate.calibration.y() + 2.0 * estimate.calibration.z(), bias_radps, 0.0012);
}

TEST(MotionEstimate, TellsABiasByTimeFromOneByDistanceWhenTheSpeedChanges) {
  const MotionEstimate estimate =
      after_driving(2000, {.heading_rate_bias_radps = 0.01}, stop_and_go);
  EXPECT_NEAR(estimate.calibration.y(), 0.01, 0.002);
  EXPECT_NEAR(estimate.calibration.z(), 0.0, 0.0005);
}

TEST(MotionEstimate, LearnsAFactorOfTurnsFromBendsToBothSides) {
  for (const double factor : {0.94, 1.06}) {
    const MotionEstimate estimate = after_driving(1500, {.turn_scale = factor}, winding_street);
    const double sigma = std::sqrt(estimate.covariance(kTurnFactor, kTurnFactor));
    EXPECT_LT(sigma, 0.02);
    EXPECT_NEAR(1.0 + estimate.calibration[kTurnFactor - 3], factor, 3.0 * sigma);
    EXPECT_NEAR(estimate.calibration.y(), 0.0, 0.001);
  }
}

TEST(MotionEstimate, LearnsThatTheScannerIsMountedAskew) {
  for (const double askew_rad : {-0.01, 0.01}) {
    const MotionEstimate estimate = after_driving(300, {.askew_rad = askew_rad}, winding_street);
    const double sigma_rad = std::sqrt(estimate.covariance(kAskew, kAskew));
    EXPECT_LT(sigma_rad, 0.001);
    EXPECT_NEAR(estimate.calibration[kAskew - 3], askew_rad, 4.0 * sigma_rad);
  }
}

/// A robot that goes straight and turns on the spot by turns; its log takes the scanner for the
/// point that the wheels speak of.
MotionEstimate after_turning_about(const geometry::Vector2& pivot_from_base_m,
                                   const MotionModelConfig& config) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 1.0);
  const Pose2 pivot_from_base{pivot_from_base_m.x(), pivot_from_base_m.y(), 0.0};
  Pose2 odom_from_base;
  MotionEstimate estimate = at_start(config);
  for (int i = 0; i < 200; ++i) {
    const Pose2 by_wheels =
        i % 10 < 5 ? Pose2{0.3, 0.0, 0.0} : Pose2{0.0, 0.0, i % 20 < 10 ? 0.4 : -0.4};
    odom_from_base =
        odom_from_base * (geometry::inverse(pivot_from_base) * by_wheels * pivot_from_base);
    estimate = moved_by_wheels(estimate, {by_wheels, kStep_s}, config);
    const Pose2 seen{odom_from_base.x_m + 0.02 * noise(random),
                     odom_from_base.y_m + 0.02 * noise(random),
                     odom_from_base.heading_rad + 0.003 * noise(random)};
    estimate = matched(estimate, fused(estimate.uncertain_pose(),
                                       {seen, Eigen::Vector3d(4e-4, 4e-4, 9e-6).asDiagonal()}));
  }
  return estimate;
}

TEST(MotionEstimate, LearnsAboutWhichPointTheVehicleTurns) {
  MotionModelConfig config;
  config.pivot_prior_m = 0.2;
  const MotionEstimate estimate = after_turning_about({0.15, -0.08}, config);
  const double sigma_m = std::sqrt(estimate.covariance(6, 6));
  EXPECT_LT(sigma_m, 0.02);
  EXPECT_NEAR(estimate.calibration[3], 0.15, 4.0 * sigma_m);
  EXPECT_NEAR(estimate.calibration[4], -0.08, 4.0 * sigma_m);
}

TEST(MotionEstimate, IsCertainOfThatPointOnlyWhereItIsNotTheBase) {
  MotionModelConfig config;
  config.pivot_prior_m = 0.2;
  EXPECT_TRUE(is_pivot_certain(after_turning_about({0.15, -0.08}, config)));
  EXPECT_FALSE(is_pivot_certain(after_turning_about({0.0, 0.0}, config)));
  EXPECT_FALSE(is_pivot_certain(at_start(config)));
}

TEST(MotionEstimate, TakesThatPointOverFromAnother) {
  MotionModelConfig config;
  config.pivot_prior_m = 0.2;
  const MotionEstimate other = after_turning_about({0.15, -0.08}, config);
  const MotionEstimate before = after_turning_about({0.15, -0.08}, kConfig);
  const MotionEstimate after = with_pivot_of(before, other);
  EXPECT_EQ(pivot_m(after), pivot_m(other));
  EXPECT_EQ(after.odom_from_base, before.odom_from_base);
  EXPECT_GT(after.covariance(6, 6), other.covariance(6, 6));
  EXPECT_EQ(after.covariance(6, 0), 0.0);
  EXPECT_EQ(after.covariance(0, 0), before.covariance(0, 0));
}

TEST(MotionEstimate, TakesTheLogsWordForThatPointWhereItIsToldTo) {
  const MotionEstimate estimate = after_turning_about({0.02, 0.0}, kConfig);
  EXPECT_EQ(estimate.calibration[3], 0.0);
  EXPECT_EQ(estimate.calibration[4], 0.0);
}

/// What becomes of the stamps' offset over a drive whose wheels are stamped later than the scans;
/// speed and yaw rate at a time as told.
template <typename Velocity>
MotionEstimate after_driving_with_late_wheels(double late_s, const Velocity& velocity_at) {
  MotionModelConfig config;
  config.stamp_offset_prior_s = 0.1;
  config.stamp_offset_walk = 0.0;
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 1.0);
  const auto step_at = [&](double time_s) {
    return arc({}, velocity_at(time_s).x(), velocity_at(time_s).y())(kStep_s);
  };
  MotionEstimate estimate = at_start(config);
  Pose2 odom_from_base;
  for (int i = 0; i < 600; ++i) {
    const double time_s = kStep_s * i;
    odom_from_base = odom_from_base * step_at(time_s);
    const double read_s = time_s - late_s + stamp_offset_s(estimate);
    const Eigen::Vector3d by_offset =
        geometry::difference(step_at(read_s + 0.05), step_at(read_s - 0.05)) / 0.1;
    estimate = moved_by_wheels(estimate, {step_at(read_s), kStep_s, by_offset}, config);
    const Pose2 seen{odom_from_base.x_m + 0.02 * noise(random),
                     odom_from_base.y_m + 0.02 * noise(random),
                     odom_from_base.heading_rad + 0.001 * noise(random)};
    estimate = matched(estimate, fused(estimate.uncertain_pose(),
                                       {seen, Eigen::Vector3d(4e-4, 4e-4, 1e-6).asDiagonal()}));
  }
  return estimate;
}

double stamp_offset_sigma_s(const MotionEstimate& estimate) {
  return std::sqrt(estimate.covariance(kStampOffset, kStampOffset));
}

Velocity of_town_traffic(double time_s) {
  return {6.0 + 5.0 * std::sin(0.5 * time_s), 0.3 * std::sin(0.8 * time_s)};
}
Velocity of_a_motorway(double) { return {25.0, 0.01}; }

TEST(MotionEstimate, LearnsByHowMuchLaterTheWheelsAreStamped) {
  for (const double late_s : {0.05, 0.0, -0.05}) {
    const MotionEstimate estimate = after_driving_with_late_wheels(late_s, of_town_traffic);
    EXPECT_LT(stamp_offset_sigma_s(estimate), 0.006);
    EXPECT_NEAR(stamp_offset_s(estimate), late_s, 3.0 * stamp_offset_sigma_s(estimate));
  }
}

TEST(MotionEstimate, LearnsNothingAboutStampsWhileNothingChanges) {
  const MotionEstimate estimate = after_driving_with_late_wheels(0.05, of_a_motorway);
  EXPECT_NEAR(stamp_offset_s(estimate), 0.0, 1e-9);
  EXPECT_NEAR(stamp_offset_sigma_s(estimate), 0.1, 1e-9);
}

TEST(MotionEstimate, GrowsUnsureOfStampsAgainButNeverMoreThanAtTheStart) {
  MotionModelConfig config;
  config.stamp_offset_prior_s = 0.01;
  MotionEstimate estimate = at_start(config);
  estimate.covariance(kStampOffset, kStampOffset) = 1e-6;
  estimate = moved_by_wheels(estimate, {{}, 4.0}, config);
  EXPECT_NEAR(stamp_offset_sigma_s(estimate), std::sqrt(1e-6 + 4e-6), 1e-9);
  for (int i = 0; i < 1000; ++i) estimate = moved_by_wheels(estimate, {{}, 1.0}, config);
  EXPECT_NEAR(stamp_offset_sigma_s(estimate), 0.01, 1e-9);
}

TEST(MatchedFrom, SaysWhatAMatchFromThatPredictionWouldHaveSaid) {
  const geometry::UncertainPose2 prediction{{1.0, 2.0, 0.3},
                                            Eigen::Vector3d(4e-4, 1e-4, 1e-6).asDiagonal()};
  const geometry::UncertainPose2 other{{1.02, 1.99, 0.301},
                                       Eigen::Vector3d(9e-4, 4e-4, 4e-6).asDiagonal()};
  const geometry::UncertainPose2 scan{{1.03, 2.01, 0.299},
                                      Eigen::Vector3d(2e-4, 3e-4, 2e-6).asDiagonal()};
  const geometry::UncertainPose2 said = matched_from(other, prediction, fused(prediction, scan));
  const geometry::UncertainPose2 expected = fused(other, scan);
  EXPECT_THAT(said.pose, PoseNear(expected.pose, 1e-12));
  EXPECT_LT((said.covariance - expected.covariance).norm(), 1e-15);
}

TEST(MatchedFrom, LeavesAPredictionAsItIsWhereTheMatchSaysNothing) {
  const geometry::UncertainPose2 prediction{{1.0, 2.0, 0.3},
                                            Eigen::Vector3d(4e-4, 1e-4, 1e-6).asDiagonal()};
  const geometry::UncertainPose2 other{{1.02, 1.99, 0.301},
                                       Eigen::Vector3d(9e-4, 4e-4, 4e-6).asDiagonal()};
  EXPECT_THAT(matched_from(other, prediction, prediction).pose, PoseNear(other.pose, 1e-12));
}

TEST(PutAt, KeepsTheCalibrationAndForgetsWhatThePoseSaysOfIt) {
  const MotionEstimate estimate = after_driving(100, {.scale = 1.01}, winding_street);
  const geometry::UncertainPose2 there{{5.0, -1.0, 0.2},
                                       Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal()};
  const MotionEstimate put = put_at(estimate, there);
  EXPECT_EQ(put.calibration, estimate.calibration);
  EXPECT_EQ(put.odom_from_base, there.pose);
  EXPECT_EQ((put.covariance.bottomRightCorner<9, 9>()),
            (estimate.covariance.bottomRightCorner<9, 9>()));
  EXPECT_EQ((put.covariance.block<3, 9>(0, 3).norm()), 0.0);
}

TEST(AgainstRenewedMap, LeavesEachAsSureAsItIs) {
  const MotionEstimate estimate = after_driving(100, {.scale = 1.01}, winding_street);
  const MotionEstimate renewed = against_renewed_map(estimate, 0.25);
  EXPECT_EQ(renewed.odom_from_base, estimate.odom_from_base);
  EXPECT_EQ(renewed.calibration, estimate.calibration);
  EXPECT_EQ((renewed.covariance.topLeftCorner<3, 3>()),
            (estimate.covariance.topLeftCorner<3, 3>()));
  EXPECT_EQ((renewed.covariance.bottomRightCorner<9, 9>()),
            (estimate.covariance.bottomRightCorner<9, 9>()));
  EXPECT_TRUE((renewed.covariance.block<3, 7>(0, 3))
                  .isApprox(0.75 * estimate.covariance.block<3, 7>(0, 3)));
  EXPECT_TRUE(renewed.covariance.isApprox(renewed.covariance.transpose()));
}

/// How sure of the scale a drive makes it whose every match says what the wheels say: the map it is
/// matched to is what they made.
double scale_sigma_after_agreeing_with_itself(double renewed_share_of_each_step) {
  MotionModelConfig config;
  config.position_noise_per_m = 0.03;  // 24 mm a step, against 30 mm by the laser
  MotionEstimate estimate = at_start(config);
  for (int i = 0; i < 300; ++i) {
    estimate = moved_by_wheels(estimate, {{0.8, 0.0, 0.0}, kStep_s}, config);
    estimate =
        matched(estimate, fused(estimate.uncertain_pose(),
                                {estimate.odom_from_base,
                                 Eigen::Vector3d(0.03 * 0.03, 0.03 * 0.03, 1e-6).asDiagonal()}));
    estimate = against_renewed_map(estimate, renewed_share_of_each_step);
  }
  return std::sqrt(estimate.covariance(3, 3));
}

TEST(AgainstRenewedMap, TakesAMapThatItsOwnWheelsMadeForLittle) {
  const double as_if_known = scale_sigma_after_agreeing_with_itself(0.0);
  const double seen_over_30_m = scale_sigma_after_agreeing_with_itself(1.0 - std::exp(-0.8 / 30.0));
  const double seen_once = scale_sigma_after_agreeing_with_itself(1.0);
  EXPECT_GT(seen_over_30_m, 1.01 * as_if_known);
  EXPECT_GT(seen_once, 1.5 * seen_over_30_m);
}

TEST(MovedByWheels, PropagatesTheCalibrationByItsNumericalDerivative) {
  MotionModelConfig config;
  config.pivot_prior_m = 0.2;
  MotionEstimate before = at_start(config);
  before.odom_from_base = {3.0, -2.0, 0.7};
  before.calibration << 0.01, 0.02, -0.01, 0.0, 0.0, 0.0, 0.03;
  const Pose2 by_wheels{0.4, 0.05, -0.6};
  const MotionEstimate after = moved_by_wheels(before, {by_wheels, kStep_s}, config);
  for (const int i : {0, 1, 2, 3, 4, 6}) {  // 5, the stamps' offset, changes nothing but by its own
                                            // derivative
    constexpr double kChange = 1e-6;
    MotionEstimate changed = before;
    changed.calibration[i] += kChange;
    const Eigen::Vector3d derivative =
        geometry::difference(moved_by_wheels(changed, {by_wheels, kStep_s}, config).odom_from_base,
                             after.odom_from_base) /
        kChange;
    const Eigen::Vector3d by_covariance =
        after.covariance.block<3, 1>(0, 3 + i) / before.covariance(3 + i, 3 + i);
    EXPECT_LT((derivative - by_covariance).norm(), 0.005)
        << i << ": " << derivative.transpose() << " and " << by_covariance.transpose();
  }
}

TEST(PredictStep, IsSurerSidewaysThanAhead) {
  const geometry::Matrix3 covariance =
      predict_step({2.0, 0.0, 0.0}, kStep_s, MotionCalibration::Zero(), kConfig).covariance;
  EXPECT_NEAR(std::sqrt(covariance(0, 0)),
              kConfig.position_noise_m + 2.0 * kConfig.position_noise_per_m, 1e-9);
  EXPECT_NEAR(std::sqrt(covariance(1, 1)),
              kConfig.position_noise_m + 2.0 * kConfig.sideways_noise_per_m, 1e-9);
}

TEST(StoodStill, IsWhereItWasAndNearlyAsSure) {
  const MotionEstimate before = after_driving(100, {.scale = 1.01}, winding_street);
  const MotionEstimate after = stood_still(before, 4.0, kConfig);
  EXPECT_THAT(after.odom_from_base, PoseNear(before.odom_from_base, 1e-15));
  EXPECT_EQ(after.velocity, Velocity::Zero());
  EXPECT_EQ(after.calibration, before.calibration);
  const Eigen::Vector3d grown = (after.covariance - before.covariance).diagonal().head<3>();
  EXPECT_NEAR(std::sqrt(grown.x()), 2.0 * kConfig.standing_noise_m_per_sqrt_s, 1e-9);
  EXPECT_NEAR(std::sqrt(grown.y()), 2.0 * kConfig.standing_noise_m_per_sqrt_s, 1e-9);
  EXPECT_NEAR(std::sqrt(grown.z()), 2.0 * kConfig.standing_noise_rad_per_sqrt_s, 1e-9);
}

TEST(MotionEstimate, StaysACovariance) {
  const MotionEstimate estimate = after_driving(3000, {.scale = 1.01}, stop_and_go);
  EXPECT_NEAR((estimate.covariance - estimate.covariance.transpose()).norm(), 0.0, 1e-12);
  EXPECT_GT((Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>>(
                 estimate.covariance.topLeftCorner<6, 6>())
                 .eigenvalues()
                 .minCoeff()),
            0.0);
}

TEST(MotionEstimate, IsAsUncertainAsItIsWrong) {
  std::mt19937 random(17);
  std::normal_distribution<double> noise(0.0, 1.0);
  constexpr int kRuns = 200, kSteps = 50;
  double nees = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const double scale = 1.0 + kConfig.scale_prior * noise(random);
    Pose2 truth;
    MotionEstimate estimate = at_start(kConfig);
    for (int i = 0; i < kSteps; ++i) {
      const Pose2 by_wheels{0.5, 0.0, 0.0};
      const Eigen::Matrix3d step_covariance =
          predict_step(by_wheels, kStep_s, estimate.calibration, kConfig).covariance;
      const Eigen::Vector3d error = step_covariance.diagonal().cwiseSqrt().cwiseProduct(
          Eigen::Vector3d(noise(random), noise(random), noise(random)));
      truth = truth * Pose2{scale * 0.5 + error.x(), error.y(), error.z()};
      estimate = moved_by_wheels(estimate, {by_wheels, kStep_s}, kConfig);
      const Pose2 seen{truth.x_m + 0.02 * noise(random), truth.y_m + 0.02 * noise(random),
                       truth.heading_rad + 0.001 * noise(random)};
      estimate = matched(estimate, fused(estimate.uncertain_pose(),
                                         {seen, Eigen::Vector3d(4e-4, 4e-4, 1e-6).asDiagonal()}));
    }
    Eigen::Vector4d error(
        estimate.odom_from_base.x_m - truth.x_m, estimate.odom_from_base.y_m - truth.y_m,
        geometry::wrap_angle(estimate.odom_from_base.heading_rad - truth.heading_rad),
        estimate.scale() - scale);
    nees +=
        error.dot(Eigen::Matrix4d(estimate.covariance.topLeftCorner<4, 4>()).inverse() * error) /
        4.0;
  }
  // Chi-square with 4 kRuns degrees of freedom: mean 1, sigma sqrt(2 / (4 kRuns)) = 0.05. Surprises
  // are left out: a little wider.
  EXPECT_NEAR(nees / kRuns, 1.0, 0.2);
}

TEST(MotionEstimate, LearnsNothingFromAVehicleThatStands) {
  const MotionEstimate after = after_driving(100, {}, [](int) { return Pose2{}; });
  EXPECT_EQ(after.scale(), 1.0);
  EXPECT_DOUBLE_EQ(std::sqrt(after.covariance(3, 3)), kConfig.scale_prior);
}

TEST(MotionEstimate, LearnsNothingFromAWrongMatch) {
  MotionEstimate estimate = after_driving(100, {.scale = 1.01}, winding_street);
  const MotionEstimate predicted = moved_by_wheels(estimate, {{0.8, 0.0, 0.0}, kStep_s}, kConfig);
  const geometry::UncertainPose2 wrong{predicted.odom_from_base * Pose2{0.8, 0.0, 0.7},
                                       Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal()};
  const MotionEstimate after = matched(predicted, wrong);
  EXPECT_EQ(after.calibration, predicted.calibration);
  EXPECT_THAT(after.odom_from_base, PoseNear(wrong.pose, 1e-15));
}

TEST(MotionEstimate, GrowsUnsureOfThePoseWithoutALaser) {
  MotionEstimate estimate = at_start(kConfig);
  double before = 0.0;
  for (int i = 0; i < 50; ++i) {
    estimate = moved_by_wheels(estimate, {{0.8, 0.0, 0.0}, kStep_s}, kConfig);
    EXPECT_GT(estimate.covariance(0, 0), before);
    before = estimate.covariance(0, 0);
  }
  EXPECT_GT(std::sqrt(before), 50 * 0.8 * kConfig.scale_prior);  // the scale is wrong in every step
                                                                 // alike
}

TEST(PredictStep, UndoesTheErrorsThatItKnows) {
  const Pose2 truth = arc({}, 10.0, 0.4)(kStep_s);
  const MotionCalibration calibration{{0.013, 0.02, 0.0, 0.0, 0.0, 0.0, 0.0}};
  const Pose2 by_wheels =
      step_by_wheels(truth, kStep_s, {.scale = 1.013, .heading_rate_bias_radps = 0.02});
  EXPECT_THAT(predict_step(by_wheels, kStep_s, calibration, kConfig).pose, PoseNear(truth, 1e-12));
}

TEST(PredictStep, WithoutKnownErrorsIsWhatTheWheelsSay) {
  const Pose2 by_wheels{0.7, -0.02, 0.05};
  EXPECT_THAT(predict_step(by_wheels, kStep_s, MotionCalibration::Zero(), kConfig).pose,
              PoseNear(by_wheels, 1e-15));
}

TEST(PredictStep, IsLessSureTheFartherItGoes) {
  const auto sigma = [](double distance_m) {
    const auto step =
        predict_step({distance_m, 0.0, 0.0}, kStep_s, MotionCalibration::Zero(), kConfig);
    return Eigen::Vector2d(std::sqrt(step.covariance(0, 0)), std::sqrt(step.covariance(2, 2)));
  };
  EXPECT_GE(sigma(0.0).x(), kConfig.position_noise_m);
  EXPECT_GT(sigma(1.0).x(), sigma(0.5).x());
  EXPECT_GT(sigma(1.0).y(), sigma(0.5).y());
}

TEST(MovedByWheels, IsSurerOnceItIsCalibrated) {
  const Pose2 by_wheels{0.8, 0.0, 0.0};
  const auto variance_added = [&](const MotionEstimate& before) {
    const MotionEstimate after = moved_by_wheels(before, {by_wheels, kStep_s}, kConfig);
    return Eigen::Vector2d(after.covariance(0, 0) - before.covariance(0, 0),
                           after.covariance(2, 2) - before.covariance(2, 2));
  };
  const Eigen::Vector2d before = variance_added(at_start(kConfig));
  const Eigen::Vector2d after = variance_added(after_driving(300, {}, [](int) {
    return Pose2{0.8, 0.0, 0.0};
  }));
  EXPECT_LT(after.x(), before.x());
  EXPECT_LT(after.y(), before.y());
}

MotionEstimate at_velocity(const Velocity& velocity, const Velocity& sigma = Velocity::Zero()) {
  MotionEstimate estimate = at_start(kConfig);
  estimate.velocity = velocity;
  estimate.covariance.bottomRightCorner<2, 2>() = sigma.cwiseAbs2().asDiagonal();
  return estimate;
}

TEST(MovedAtVelocity, FollowsTheArc) {
  for (const double yaw_rate_radps : {0.0, 0.3, -0.8}) {
    EXPECT_THAT(
        moved_at_velocity(at_velocity({5.0, yaw_rate_radps}), kStep_s, kConfig).odom_from_base,
        PoseNear(arc({}, 5.0, yaw_rate_radps)(kStep_s), 2e-4));
  }
}

TEST(MovedAtVelocity, IsAsUnsureInOneStepAsInMany) {
  MotionEstimate in_many = at_velocity({5.0, 0.0}, {0.5, 0.1});
  const MotionEstimate in_one = moved_at_velocity(in_many, 1.0, kConfig);
  for (int i = 0; i < 100; ++i) in_many = moved_at_velocity(in_many, 0.01, kConfig);
  // of every step
  const double floor_m2 = 99 * kConfig.position_noise_m * kConfig.position_noise_m;
  EXPECT_NEAR(in_many.covariance(0, 0) - floor_m2, in_one.covariance(0, 0),
              1e-3 * in_one.covariance(0, 0));
  EXPECT_NEAR(in_many.covariance(kSpeed, kSpeed), in_one.covariance(kSpeed, kSpeed), 1e-9);
  EXPECT_NEAR(in_many.covariance(0, kSpeed), in_one.covariance(0, kSpeed),
              1e-3 * in_one.covariance(0, kSpeed));
}

TEST(MovedAtVelocity, KeepsItsCovarianceOneThroughALongStepThatTurns) {
  const MotionEstimate after = moved_at_velocity(at_velocity({3.0, 0.9}), 2.2, kConfig);
  const Eigen::SelfAdjointEigenSolver<MotionCovariance> solver(after.covariance);
  EXPECT_GT(solver.eigenvalues().minCoeff(), -1e-9);
}

TEST(MovedAtVelocity, MaySlideSidewaysWhereItTurns) {
  const MotionModelConfig config;
  ASSERT_GT(config.pivot_walk_m, 0.0);
  const auto sideways_sigma_m = [&](double yaw_rate_radps, double duration_s) {
    return std::sqrt(
        moved_at_velocity(at_velocity({5.0, yaw_rate_radps}), duration_s, config).covariance(1, 1));
  };
  EXPECT_LT(sideways_sigma_m(0.0, kStep_s), 0.25 * sideways_sigma_m(-0.5, kStep_s));
  EXPECT_NEAR(sideways_sigma_m(-0.5, kStep_s), 0.5 * config.pivot_walk_m * std::sqrt(kStep_s),
              0.1 * sideways_sigma_m(-0.5, kStep_s));
}

TEST(MovedAtVelocity, LearnsTheVelocityFromTheLaserAlone) {
  std::mt19937 random(9);
  std::normal_distribution<double> noise(0.0, 1.0);
  MotionEstimate estimate = at_start(kConfig);
  Pose2 truth;
  for (int i = 0; i < 100; ++i) {
    truth = truth * arc({}, 12.0, 0.2)(kStep_s);
    estimate = moved_at_velocity(estimate, kStep_s, kConfig);
    const Pose2 seen{truth.x_m + 0.02 * noise(random), truth.y_m + 0.02 * noise(random),
                     truth.heading_rad + 0.001 * noise(random)};
    estimate = matched(estimate, fused(estimate.uncertain_pose(),
                                       {seen, Eigen::Vector3d(4e-4, 4e-4, 1e-6).asDiagonal()}));
  }
  EXPECT_NEAR(estimate.velocity.x(), 12.0, 4.0 * std::sqrt(estimate.covariance(kSpeed, kSpeed)));
  EXPECT_NEAR(estimate.velocity.y(), 0.2,
              4.0 * std::sqrt(estimate.covariance(kSpeed + 1, kSpeed + 1)));
  EXPECT_LT(std::sqrt(estimate.covariance(kSpeed, kSpeed)), 2.0);
}

TEST(MovedByWheels, TakesTheVelocityFromThem) {
  const MotionEstimate after =
      moved_by_wheels(at_velocity({1.0, 1.0}, {5.0, 5.0}), {{0.8, 0.0, 0.02}, kStep_s}, kConfig);
  EXPECT_NEAR(after.velocity.x(), 8.0, 1e-6);
  EXPECT_NEAR(after.velocity.y(), 0.2, 1e-6);
  EXPECT_EQ((after.covariance.block<kSpeed, 2>(0, kSpeed).norm()), 0.0);
}

}  // namespace
}  // namespace slammot::sensing
