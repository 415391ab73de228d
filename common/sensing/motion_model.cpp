#include "common/sensing/motion_model.hpp"

#include <cmath>

#include <Eigen/Cholesky>

namespace slammot::sensing {
namespace {

using geometry::Pose2;

double squared(double value) { return value * value; }

constexpr double kSurprise = 16.3;  // chi-square, 3 degrees of freedom, 99.9 %

using Matrix35 = Eigen::Matrix<double, 3, 5>;

/// How far a point moves that is off the pivot by one metre: what turns about the pivot swings.
geometry::Matrix2 swing(double turned_rad) { return geometry::rotation(turned_rad) - geometry::Matrix2::Identity(); }

/// Derivative of the corrected step by the calibration; that of the swing by the biases is left out: millimetres of decimetres.
Matrix35 step_by_calibration(const Pose2& by_wheels, double duration_s, const MotionCalibration& calibration) {
  const double distance_m = std::hypot(by_wheels.x_m, by_wheels.y_m);
  const double turn_bias_rad = calibration.y() * duration_s + calibration.z() * distance_m;
  const geometry::Vector2 turned_m = geometry::rotation(0.5 * turn_bias_rad) * by_wheels.translation_m();
  const geometry::Vector2 by_turn_m = 0.5 * (1.0 + calibration.x()) * geometry::Vector2(-turned_m.y(), turned_m.x());
  const geometry::Matrix2 by_pivot = swing(by_wheels.heading_rad + turn_bias_rad);
  Matrix35 J;
  J << turned_m.x(), by_turn_m.x() * duration_s, by_turn_m.x() * distance_m, by_pivot(0, 0), by_pivot(0, 1),
       turned_m.y(), by_turn_m.y() * duration_s, by_turn_m.y() * distance_m, by_pivot(1, 0), by_pivot(1, 1),
       0.0, duration_s, distance_m, 0.0, 0.0;
  return J;
}

}  // namespace

MotionEstimate at_start(const MotionModelConfig& config) {
  MotionEstimate estimate;
  estimate.covariance.diagonal().tail<5>() << squared(config.scale_prior), squared(config.heading_rate_bias_prior_radps),
      squared(config.heading_per_metre_bias_prior), squared(config.pivot_prior_m), squared(config.pivot_prior_m);
  return estimate;
}

geometry::UncertainPose2 predict_step(const Pose2& before_from_base_by_wheels, double duration_s,
                                      const MotionCalibration& calibration, const MotionModelConfig& config) {
  const Pose2& wheels = before_from_base_by_wheels;
  const double distance_m = std::hypot(wheels.x_m, wheels.y_m);
  const double turn_bias_rad = calibration.y() * duration_s + calibration.z() * distance_m;
  // Half of the missing turn happened before the middle of the step.
  const geometry::Vector2 moved_m = geometry::rotation(0.5 * turn_bias_rad) * wheels.translation_m() * (1.0 + calibration.x()) +
                                    swing(wheels.heading_rad + turn_bias_rad) * calibration.tail<2>();
  geometry::UncertainPose2 step;
  step.pose = {moved_m.x(), moved_m.y(), geometry::wrap_angle(wheels.heading_rad + turn_bias_rad)};
  const double position_m = config.position_noise_m + distance_m * config.position_noise_per_m;
  const double heading_rad = config.heading_noise_rad + config.heading_noise_per_m * distance_m +
                             config.heading_noise_per_rad * std::abs(wheels.heading_rad);
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

MotionEstimate moved_by_wheels(const MotionEstimate& before, const Pose2& before_from_base_by_wheels, double duration_s,
                               const MotionModelConfig& config) {
  const geometry::UncertainPose2 step = predict_step(before_from_base_by_wheels, duration_s, before.calibration, config);
  MotionEstimate after = moved(before, step);
  const Matrix35 by_calibration = geometry::compound_jacobian_second(before.odom_from_base) *
                                  step_by_calibration(before_from_base_by_wheels, duration_s, before.calibration);
  const Matrix35 cross = after.covariance.topRightCorner<3, 5>();
  const Eigen::Matrix<double, 5, 5> of_calibration = before.covariance.bottomRightCorner<5, 5>();
  const geometry::Matrix3 mixed = by_calibration * cross.transpose();
  after.covariance.topLeftCorner<3, 3>() += by_calibration * of_calibration * by_calibration.transpose() + mixed + mixed.transpose();
  after.covariance.topRightCorner<3, 5>() += by_calibration * of_calibration;
  after.covariance.bottomLeftCorner<5, 3>() = after.covariance.topRightCorner<3, 5>().transpose();
  const double distance_m = std::hypot(before_from_base_by_wheels.x_m, before_from_base_by_wheels.y_m);
  after.covariance(3, 3) += squared(config.scale_walk_per_sqrt_m) * distance_m;
  after.covariance(4, 4) += squared(config.heading_rate_bias_walk) * duration_s;
  return after;
}

MotionEstimate moved(const MotionEstimate& before, const geometry::UncertainPose2& before_from_base) {
  MotionEstimate after = before;
  after.odom_from_base = before.odom_from_base * before_from_base.pose;
  const geometry::Matrix3 by_before = geometry::compound_jacobian_first(before.odom_from_base, before_from_base.pose);
  const geometry::Matrix3 by_step = geometry::compound_jacobian_second(before.odom_from_base);
  after.covariance.topLeftCorner<3, 3>() = by_before * before.covariance.topLeftCorner<3, 3>() * by_before.transpose() +
                                           by_step * before_from_base.covariance * by_step.transpose();
  after.covariance.topRightCorner<3, 5>() = by_before * before.covariance.topRightCorner<3, 5>();
  after.covariance.bottomLeftCorner<5, 3>() = after.covariance.topRightCorner<3, 5>().transpose();
  return after;
}

MotionEstimate matched(const MotionEstimate& predicted, const geometry::UncertainPose2& odom_from_base) {
  MotionEstimate estimate = predicted;
  estimate.odom_from_base = odom_from_base.pose;
  const geometry::Matrix3 prior = predicted.covariance.topLeftCorner<3, 3>();
  const Eigen::Matrix<double, 5, 3> cross = predicted.covariance.bottomLeftCorner<5, 3>();
  const Eigen::Vector3d surprise = geometry::difference(odom_from_base.pose, predicted.odom_from_base);
  const Eigen::LDLT<geometry::Matrix3> factors(prior);
  const bool is_credible = surprise.dot(factors.solve(surprise)) < kSurprise;
  Eigen::Matrix<double, 5, 3> gain = Eigen::Matrix<double, 5, 3>::Zero();
  if (is_credible) gain = factors.solve(cross.transpose()).transpose();
  estimate.calibration += gain * surprise;
  estimate.covariance.topLeftCorner<3, 3>() = odom_from_base.covariance;
  estimate.covariance.bottomLeftCorner<5, 3>() = gain * odom_from_base.covariance;
  estimate.covariance.topRightCorner<3, 5>() = estimate.covariance.bottomLeftCorner<5, 3>().transpose();
  estimate.covariance.bottomRightCorner<5, 5>() -= gain * (prior - odom_from_base.covariance) * gain.transpose();
  return estimate;
}

}  // namespace slammot::sensing
