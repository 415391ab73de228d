#pragma once

#include "common/geometry/uncertain_pose2.hpp"

namespace slammot::sensing {

/// What is not known of the wheels: one-sigma figures. Wide enough to let the laser decide.
struct MotionModelConfig {
  double position_noise_m = 0.0005;             ///< A step of any length; wheels that stand slip little,
  double position_noise_per_m = 0.06;           ///< and for each metre of it (added), ahead
  double sideways_noise_per_m = 0.01;           ///< and sideways.
  double heading_noise_rad = 0.001;
  double heading_noise_per_m = 0.004;
  double heading_noise_per_rad = 0.05;
  double standing_noise_m_per_sqrt_s = 0.0001;  ///< Where wheels have stood for a while: nothing slides but by what leans on the brakes.
  double standing_noise_rad_per_sqrt_s = 0.00003;
  double scale_prior = 0.02;                    ///< Of the factor on wheel distance, about 1.
  double heading_rate_bias_prior_radps = 0.005;
  double heading_per_metre_bias_prior = 0.02;   ///< [rad/m]: unequal wheels.
  double pivot_prior_m = 0.0;                   ///< Of the place about which the vehicle turns, where logs take the scanner for it.
  double askew_prior_rad = 0.006;               ///< Of the direction of the wheels' way, against the base's x axis.
  double stamp_offset_prior_s = 0.05;           ///< Of how much later the odometry's stamps are than the scans'; 0: they have one clock.
  double scale_walk_per_sqrt_m = 5e-5;          ///< How the scale wanders with the distance,
  double heading_rate_bias_walk = 5e-5;         ///< and the heading-rate bias with time [rad/s per sqrt(s)].
  double stamp_offset_walk = 0.001;             ///< How that offset wanders with time [s per sqrt(s)]; never less sure than at the start.
  double speed_prior_mps = 20.0;                ///< Without odometry: how fast it may be at the start,
  double yaw_rate_prior_radps = 1.0;
  double pivot_walk_m = 0.3;                    ///< from how far ahead or behind the point comes about which it turns, for about a second at a time,
  double speed_walk_mps = 3.0;                  ///< and how the velocity wanders [m/s per sqrt(s)],
  double yaw_rate_walk_radps = 1.0;             ///< as vehicles accelerate for about a second at a time [rad/s per sqrt(s)].
};

/// Systematic errors of the odometry: (scale - 1 [-], heading-rate bias [rad/s], heading bias by distance [rad/m], where
/// the base is ahead of and left of the point that the wheels speak of [m, m], how much later than the scans it is stamped [s], and
/// how far left of the base's x axis the wheels go [rad]: the base is where the scanner says, which may be mounted askew).
constexpr int kCalibrations = 7;
using MotionCalibration = Eigen::Matrix<double, kCalibrations, 1>;
/// (forward [m/s], yaw rate [rad/s]).
using Velocity = Eigen::Vector2d;
constexpr int kMotionStates = 3 + kCalibrations + 2;
using MotionCovariance = Eigen::Matrix<double, kMotionStates, kMotionStates>;

/// What odometry says of a step.
struct WheelStep {
  geometry::Pose2 before_from_base;
  double duration_s = 0.0;
  Eigen::Vector3d by_stamp_offset = Eigen::Vector3d::Zero();  ///< Its derivative by the offset of the stamps at which it is read: only changes of the velocity show.
};

/// Where the vehicle is, what is wrong with its odometry and, where it has none, how fast it is, as one Gaussian. They belong together: an odometry that is
/// one percent short makes every prediction late by a little, and only what the laser says beyond all of these
/// predictions, not the single step, tells it from noise. Taken apart, the prediction's error leaks into the map.
struct MotionEstimate {
  geometry::Pose2 odom_from_base;
  MotionCalibration calibration = MotionCalibration::Zero();
  Velocity velocity = Velocity::Zero();
  MotionCovariance covariance = MotionCovariance::Zero(); ///< Of (x [m], y [m], heading [rad], calibration, velocity); the pose against the local map.

  geometry::UncertainPose2 uncertain_pose() const { return {odom_from_base, covariance.topLeftCorner<3, 3>()}; }
  double scale() const { return 1.0 + calibration.x(); }
};

constexpr int kStampOffset = 8;  ///< Its row of the covariance,
constexpr int kAskew = 9;        ///< and that of the direction of the wheels' way.

/// By how much later than the scans the odometry is stamped, as believed.
inline double stamp_offset_s(const MotionEstimate& estimate) { return estimate.calibration[kStampOffset - 3]; }

/// At the origin of odom, with nothing known of the odometry.
MotionEstimate at_start(const MotionModelConfig& config);

/// Motion over one step as odometry, corrected by the calibration, has it. The covariance is the step's own: that of the
/// calibration is not in it.
/// before_from_base_by_wheels: difference of two odometry readings duration_s apart, at the stamps with the offset.
geometry::UncertainPose2 predict_step(const geometry::Pose2& before_from_base_by_wheels, double duration_s,
                                      const MotionCalibration& calibration, const MotionModelConfig& config);

/// After a step by wheels, before the scan is matched. The velocity is theirs.
MotionEstimate moved_by_wheels(const MotionEstimate& before, const WheelStep& by_wheels, const MotionModelConfig& config);

/// After a step of wheels that stand, and have stood for a while.
MotionEstimate stood_still(const MotionEstimate& before, double duration_s, const MotionModelConfig& config);

/// After a step of which the wheels say nothing: on at the velocity, which wanders (Wiener process).
MotionEstimate moved_at_velocity(const MotionEstimate& before, double duration_s, const MotionModelConfig& config);

/// The same estimate, less sure of its velocity: whatever else it may be is this far from it.
MotionEstimate with_doubted_velocity(const MotionEstimate& estimate, const Velocity& off);

/// What the match, which took the prediction's pose for its prior, says of the calibration and the velocity too: conditional Gaussian.
/// A surprise beyond what the prediction allows is a wrong match or a slipping wheel: it moves the pose alone.
MotionEstimate matched(const MotionEstimate& predicted, const geometry::UncertainPose2& odom_from_base);

/// Once a share of the map in view is what scans since then put there: by poses that were off just as this one is, so that against this
/// part of the map it is not. What the pose has in common with the calibration falls by that share; each alone stays as sure as it is.
/// Without it the filter takes a map for exact that was made by wheels one percent short, and thinks that it sees them right.
MotionEstimate against_renewed_map(const MotionEstimate& estimate, double renewed_share);

/// What the scan says of another estimate of the same motion than that whose prediction was matched: the match's information beyond its prior (information filter).
/// The result is to be told to matched() with the other prediction.
geometry::UncertainPose2 matched_from(const geometry::UncertainPose2& other_prediction, const geometry::UncertainPose2& prediction, const geometry::UncertainPose2& match);

/// The same calibration at another pose, which tells nothing of it.
MotionEstimate put_at(const MotionEstimate& estimate, const geometry::UncertainPose2& odom_from_base);

}  // namespace slammot::sensing
