#pragma once

#include "common/geometry/uncertain_pose2.hpp"

namespace slammot::sensing {

/// Noise and priors of odometry, one sigma each. They are wide enough for the match to dominate.
struct MotionModelConfig {
  double position_noise_m = 0.0005;    ///< For a step of any length; wheels at rest slip little.
  double position_noise_per_m = 0.06;  ///< Added for each metre of the step, along the way
  double sideways_noise_per_m = 0.01;  ///< and across it.
  double heading_noise_rad = 0.001;
  double heading_noise_per_m = 0.004;
  double heading_noise_per_rad = 0.05;
  double standing_noise_m_per_sqrt_s = 0.0001;  ///< After the wheels have stood for a while: only a
                                                ///< load on the brakes moves them.
  double standing_noise_rad_per_sqrt_s = 0.00003;
  double scale_prior = 0.02;  ///< Of the factor on wheel distance; its mean is 1.
  double heading_rate_bias_prior_radps = 0.005;
  double heading_per_metre_bias_prior = 0.02;  ///< [rad/m]: from unequal wheels.
  double turn_factor_prior = 0.05;             ///< Of the factor on wheel turns; its mean is 1.
  double pivot_prior_m = 0.0;           ///< Of the turning point, for logs of the pose of the
                                        ///< scanner.
  double doubted_pivot_prior_m = 0.2;   ///< Where that is 0: of a mounting that is not as said. It
                                        ///< is estimated beside, and used once it is certain.
  double askew_prior_rad = 0.006;       ///< Of the direction of odometry's way against the base's x
                                        ///< axis.
  double stamp_offset_prior_s = 0.05;   ///< Of the lateness of odometry's stamps; 0: odometry and
                                        ///< scans have one clock.
  double scale_walk_per_sqrt_m = 5e-5;  ///< Random walk of the scale with the distance.
  double heading_rate_bias_walk = 5e-5;  ///< Random walk of the heading-rate bias with time [rad/s
                                         ///< per sqrt(s)].
  double stamp_offset_walk = 0.001;  ///< Random walk of the lateness with time [s per sqrt(s)]; its
                                     ///< sigma is at most the prior.
  double speed_prior_mps = 20.0;     ///< Without odometry: sigma of the speed at the start.
  double yaw_rate_prior_radps = 1.0;
  double pivot_walk_m = 0.3;    ///< Sigma of the turning point along x; correlation time about a
                                ///< second.
  double speed_walk_mps = 3.0;  ///< Random walk of the speed [m/s per sqrt(s)].
  double yaw_rate_walk_radps = 1.0;  ///< Random walk of the yaw rate [rad/s per sqrt(s)];
                                     ///< accelerations last about a second.
};

/// Systematic errors of odometry: (scale - 1 [-], heading-rate bias [rad/s], heading bias by
/// distance [rad/m], position of the base ahead of and left of odometry's reference point [m, m],
/// lateness of odometry's stamps [s], angle of odometry's way left of the base's x axis [rad],
/// factor on odometry's turns - 1 [-]). The base is defined by the scanner, which may be mounted
/// askew.
constexpr int kCalibrations = 8;
using MotionCalibration = Eigen::Matrix<double, kCalibrations, 1>;
/// (forward [m/s], yaw rate [rad/s]).
using Velocity = Eigen::Vector2d;
constexpr int kMotionStates = 3 + kCalibrations + 2;
using MotionCovariance = Eigen::Matrix<double, kMotionStates, kMotionStates>;

/// A step by odometry.
struct WheelStep {
  geometry::Pose2 before_from_base;
  double duration_s = 0.0;
  Eigen::Vector3d by_stamp_offset = Eigen::Vector3d::Zero();  ///< Derivative by the lateness;
                                                              ///< nonzero only if the velocity
                                                              ///< changes.
  double turn_variance_rad2 = 0.0;  ///< Of the turn, beyond what the motion model has.
};

/// Joint Gaussian of the pose, odometry's calibration and, without odometry, the velocity. They
/// must be estimated jointly: a scale error of one percent biases every prediction a little, and
/// only the innovations of many matches tell it from noise. With separate estimates the
/// prediction's error would leak into the map.
struct MotionEstimate {
  geometry::Pose2 odom_from_base;
  MotionCalibration calibration = MotionCalibration::Zero();
  Velocity velocity = Velocity::Zero();
  MotionCovariance covariance = MotionCovariance::Zero();  ///< Of (x [m], y [m], heading [rad] in
                                                           ///< the local map, calibration,
                                                           ///< velocity).

  geometry::UncertainPose2 uncertain_pose() const {
    return {odom_from_base, covariance.topLeftCorner<3, 3>()};
  }
  double scale() const { return 1.0 + calibration.x(); }
};

constexpr int kPivot = 6;        ///< First of the two rows of the turning point in the covariance.
constexpr int kStampOffset = 8;  ///< Row of the lateness in the covariance.
constexpr int kAskew = 9;        ///< Row of the direction of odometry's way in the covariance.
constexpr int kTurnFactor = 10;  ///< Row of the factor on turns in the covariance.
/// Rows of what factors on ways and turns (WheelFactors) take the place of.
inline constexpr std::array kWheelRows = {3, 4, 5, kTurnFactor};

/// Estimated lateness of odometry's stamps.
inline double stamp_offset_s(const MotionEstimate& estimate) {
  return estimate.calibration[kStampOffset - 3];
}

/// Turning point: the base ahead and to the left of odometry's reference point.
inline geometry::Vector2 pivot_m(const MotionEstimate& estimate) {
  return estimate.calibration.segment<2>(kPivot - 3);
}

/// True if the turning point is surely not the base.
bool is_pivot_certain(const MotionEstimate& estimate);

/// The estimate with the turning point of another one of the same motion.
MotionEstimate with_pivot_of(MotionEstimate estimate, const MotionEstimate& other);

/// Initial state: the origin of odom, with the priors of the calibration.
MotionEstimate at_start(const MotionModelConfig& config);

/// Step by odometry, corrected by the calibration. The covariance is the step's own, without that
/// of the calibration. before_from_base_by_wheels: difference of two odometry readings duration_s
/// apart, read at the stamps with the lateness.
geometry::UncertainPose2 predict_step(const geometry::Pose2& before_from_base_by_wheels,
                                      double duration_s, const MotionCalibration& calibration,
                                      const MotionModelConfig& config);

/// Predicts by an odometry step; the velocity is that of odometry.
MotionEstimate moved_by_wheels(const MotionEstimate& before, const WheelStep& by_wheels,
                               const MotionModelConfig& config);

/// Predicts a step during which the wheels have been at rest for a while.
MotionEstimate stood_still(const MotionEstimate& before, double duration_s,
                           const MotionModelConfig& config);

/// Predicts a step without odometry: constant velocity with a Wiener process.
MotionEstimate moved_at_velocity(const MotionEstimate& before, double duration_s,
                                 const MotionModelConfig& config);

/// Adds this covariance to the velocity, for hypotheses that differ from the estimate by this much.
MotionEstimate with_doubted_velocity(const MotionEstimate& estimate, const Velocity& off);

/// Updates calibration and velocity with a match whose prior was the prediction: conditional
/// Gaussian. An innovation beyond the prediction's gate is a wrong match or wheel slip; it corrects
/// the pose only.
MotionEstimate matched(const MotionEstimate& predicted,
                       const geometry::UncertainPose2& odom_from_base);

/// Reduces the cross-covariance of pose and calibration by the share of the map in view that recent
/// scans made. Recent poses have the same calibration error, so that it is not observable against
/// that part of the map. The marginal covariances do not change. Otherwise the filter would take a
/// map built with a scale error of one percent as exact, and confirm that error.
MotionEstimate against_renewed_map(const MotionEstimate& estimate, double renewed_share);

/// Updates another prediction of the same motion with the match's information beyond its prior
/// (information filter). Pass the result to matched() with that prediction.
geometry::UncertainPose2 matched_from(const geometry::UncertainPose2& other_prediction,
                                      const geometry::UncertainPose2& prediction,
                                      const geometry::UncertainPose2& match);

/// The same calibration at another pose, uncorrelated with it.
MotionEstimate put_at(const MotionEstimate& estimate,
                      const geometry::UncertainPose2& odom_from_base);

}  // namespace slammot::sensing
