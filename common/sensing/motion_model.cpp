#include "common/sensing/motion_model.hpp"

#include <cmath>

namespace slammot::sensing {
namespace {

using geometry::Pose2;

double squared(double value) { return value * value; }

/// One scalar measurement of the Kalman filter.
void update(MotionCalibration& calibration, const Eigen::Vector3d& h, double innovation, double variance) {
  const Eigen::Vector3d Ph = calibration.covariance * h;
  const double S = h.dot(Ph) + variance;
  if (squared(innovation) > 9.0 * S) return;  // a wrong match or a slipping wheel tells nothing about the calibration
  const Eigen::Vector3d K = Ph / S;
  calibration.state += K * innovation;
  calibration.covariance -= K * Ph.transpose();
}

}  // namespace

MotionCalibration uncalibrated(const MotionModelConfig& config) {
  MotionCalibration calibration;
  calibration.covariance.diagonal() << squared(config.scale_prior), squared(config.heading_rate_bias_prior_radps),
      squared(config.heading_per_metre_bias_prior);
  return calibration;
}

geometry::UncertainPose2 predict_step(const Pose2& before_from_base_by_wheels, double duration_s,
                                      const MotionCalibration& calibration, const MotionModelConfig& config) {
  const Pose2& wheels = before_from_base_by_wheels;
  const double distance_m = std::hypot(wheels.x_m, wheels.y_m);
  const double turn_bias_rad = calibration.state.y() * duration_s + calibration.state.z() * distance_m;
  // Half of the missing turn happened before the middle of the step.
  const geometry::Vector2 moved_m = geometry::rotation(0.5 * turn_bias_rad) * wheels.translation_m() * calibration.scale();
  geometry::UncertainPose2 step;
  step.pose = {moved_m.x(), moved_m.y(), geometry::wrap_angle(wheels.heading_rad + turn_bias_rad)};
  const double position_m = config.position_noise_m + distance_m * (config.position_noise_per_m + std::sqrt(calibration.covariance(0, 0)));
  const double heading_rad = config.heading_noise_rad + config.heading_noise_per_m * distance_m +
                             config.heading_noise_per_rad * std::abs(wheels.heading_rad) +
                             std::sqrt(calibration.covariance(1, 1)) * duration_s +
                             std::sqrt(calibration.covariance(2, 2)) * distance_m;
  step.covariance.diagonal() << squared(position_m), squared(position_m), squared(heading_rad);
  return step;
}

geometry::UncertainPose2 predict_step_at_velocity(double speed_mps, double yaw_rate_radps, double duration_s,
                                                  const MotionModelConfig& config) {
  const double turn_rad = yaw_rate_radps * duration_s;
  const double distance_m = speed_mps * duration_s;
  const double position_m = config.position_noise_m + 0.5 * config.standstill_acceleration_mps2 * squared(duration_s);
  const double heading_rad = config.heading_noise_rad + 0.5 * config.standstill_turn_acceleration_radps2 * squared(duration_s);
  geometry::UncertainPose2 step;
  step.pose = {distance_m * std::cos(0.5 * turn_rad), distance_m * std::sin(0.5 * turn_rad), geometry::wrap_angle(turn_rad)};
  step.covariance.diagonal() << squared(position_m), squared(position_m), squared(heading_rad);
  return step;
}

MotionCalibration calibrated(const MotionCalibration& calibration, const Pose2& before_from_base_by_wheels,
                             const Pose2& before_from_base_by_match, double duration_s, const MotionModelConfig& config) {
  constexpr double kLeastStep_m = 0.02;
  MotionCalibration learned = calibration;
  const double distance_m = std::hypot(before_from_base_by_wheels.x_m, before_from_base_by_wheels.y_m);
  const double forward_m = before_from_base_by_wheels.x_m;
  if (distance_m < kLeastStep_m) return learned;
  update(learned, {forward_m, 0.0, 0.0}, before_from_base_by_match.x_m - forward_m * calibration.scale(),
         squared(config.match_position_noise_m) + squared(config.position_noise_per_m * distance_m));
  const double turn_rad = geometry::wrap_angle(before_from_base_by_match.heading_rad - before_from_base_by_wheels.heading_rad);
  update(learned, {0.0, duration_s, distance_m},
         turn_rad - calibration.state.y() * duration_s - calibration.state.z() * distance_m,
         squared(config.match_heading_noise_rad) + squared(config.heading_noise_per_m * distance_m) +
             squared(config.heading_noise_per_rad * before_from_base_by_wheels.heading_rad));
  return learned;
}

}  // namespace slammot::sensing
