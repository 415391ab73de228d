#pragma once

#include "common/geometry/uncertain_pose2.hpp"

namespace slammot::sensing {

/// What is not known of the wheels: one-sigma figures. Wide enough to let the laser decide.
struct MotionModelConfig {
  double position_noise_m = 0.004;              ///< A step of any length,
  double position_noise_per_m = 0.02;           ///< and for each metre of it (added).
  double heading_noise_rad = 0.004;
  double heading_noise_per_m = 0.01;
  double heading_noise_per_rad = 0.05;
  double scale_prior = 0.02;                    ///< Of the factor on wheel distance, about 1.
  double heading_rate_bias_prior_radps = 0.005;
  double heading_per_metre_bias_prior = 0.02;   ///< [rad/m]: unequal wheels.
  double match_position_noise_m = 0.015;        ///< How far the matched step from scan to scan is off,
  double match_heading_noise_rad = 0.003;       ///< as calibration should see it.
  double standstill_acceleration_mps2 = 3.0;    ///< Without odometry: how much the velocity may have changed.
  double standstill_turn_acceleration_radps2 = 1.0;
};

/// Systematic errors of the odometry, estimated while driving: Kalman filter over
/// (scale - 1 [-], heading-rate bias [rad/s], heading bias by distance [rad/m]).
struct MotionCalibration {
  Eigen::Vector3d state = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double scale() const { return 1.0 + state.x(); }
};

MotionCalibration uncalibrated(const MotionModelConfig& config);

/// Motion over one step as odometry, corrected by the calibration, has it. The covariance is the step's own.
/// before_from_base_by_wheels: difference of two odometry readings duration_s apart.
geometry::UncertainPose2 predict_step(const geometry::Pose2& before_from_base_by_wheels, double duration_s,
                                      const MotionCalibration& calibration, const MotionModelConfig& config);

/// Motion at constant velocity, for vehicles without odometry. The covariance allows for accelerations.
geometry::UncertainPose2 predict_step_at_velocity(double speed_mps, double yaw_rate_radps, double duration_s,
                                                  const MotionModelConfig& config);

/// Learns from what the match says about the same step.
MotionCalibration calibrated(const MotionCalibration& calibration, const geometry::Pose2& before_from_base_by_wheels,
                             const geometry::Pose2& before_from_base_by_match, double duration_s,
                             const MotionModelConfig& config);

}  // namespace slammot::sensing
