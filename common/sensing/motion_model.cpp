#include "common/sensing/motion_model.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "common/geometry/squared.hpp"

namespace slammot::sensing {
namespace {

using geometry::Pose2;

using geometry::squared;

constexpr double kSurprise = 16.3;  // chi-square, 3 degrees of freedom, 99.9 %

using Matrix32 = Eigen::Matrix<double, 3, 2>;

/// Growth of the variances of (forward speed, yaw rate) per second.
Eigen::Vector2d velocity_walk(const MotionModelConfig& config) {
  return {squared(config.speed_walk_mps), squared(config.yaw_rate_walk_radps)};
}

constexpr int kBesidesPose = kMotionStates - 3;
using ByCalibration = Eigen::Matrix<double, 3, kCalibrations>;
using ByAllBesidesPose = Eigen::Matrix<double, 3, kBesidesPose>;

double askew_rad(const MotionCalibration& calibration) { return calibration[kAskew - 3]; }

/// Turn that the wheels missed [rad].
double turn_bias(const Pose2& by_wheels, double duration_s, const MotionCalibration& calibration) {
  return calibration.y() * duration_s + calibration.z() * std::hypot(by_wheels.x_m, by_wheels.y_m) +
         calibration[kTurnFactor - 3] * by_wheels.heading_rad;
}

/// Standard deviation of the motion of a point 1 m off the pivot: rotation about an uncertain pivot
/// moves the base sideways.
geometry::Matrix2 swing(double turned_rad) {
  return geometry::rotation(turned_rad) - geometry::Matrix2::Identity();
}

/// Jacobian of the corrected step by the calibration. The derivative of the pivot term by the
/// biases is neglected: it is millimetres in decimetres.
ByCalibration step_by_calibration(const WheelStep& step, const MotionCalibration& calibration) {
  const Pose2& by_wheels = step.before_from_base;
  const double duration_s = step.duration_s;
  const double distance_m = std::hypot(by_wheels.x_m, by_wheels.y_m);
  const double turn_rad = by_wheels.heading_rad;
  const double turn_bias_rad = turn_bias(by_wheels, duration_s, calibration);
  const geometry::Vector2 turned_m =
      geometry::rotation(askew_rad(calibration) + 0.5 * turn_bias_rad) * by_wheels.translation_m();
  const geometry::Vector2 by_askew_m =
      (1.0 + calibration.x()) * geometry::Vector2(-turned_m.y(), turned_m.x());
  const geometry::Vector2 by_turn_m = 0.5 * by_askew_m;
  const geometry::Matrix2 by_pivot = swing(by_wheels.heading_rad + turn_bias_rad);
  ByCalibration J;
  J << turned_m.x(), by_turn_m.x() * duration_s, by_turn_m.x() * distance_m, by_pivot(0, 0),
      by_pivot(0, 1), step.by_stamp_offset.x(), by_askew_m.x(), by_turn_m.x() * turn_rad,
      turned_m.y(), by_turn_m.y() * duration_s, by_turn_m.y() * distance_m, by_pivot(1, 0),
      by_pivot(1, 1), step.by_stamp_offset.y(), by_askew_m.y(), by_turn_m.y() * turn_rad, 0.0,
      duration_s, distance_m, 0.0, 0.0, step.by_stamp_offset.z(), 0.0, turn_rad;
  return J;
}

/// Covariance of a step at constant velocity, since the velocity (whose Jacobian is given) is a
/// Wiener process, plus the noise of any step. If the vehicle turns about another point than the
/// base, the base moves sideways at the turn rate times the distance, for as long as it turns.
geometry::Matrix3 noise_at_velocity(const Matrix32& step_by_velocity, double duration_s,
                                    double yaw_rate_radps, const MotionModelConfig& config) {
  const double sideways_m2 = squared(config.pivot_walk_m * yaw_rate_radps) * duration_s;
  const Eigen::Vector3d of_any_step(squared(config.position_noise_m),
                                    squared(config.position_noise_m) + sideways_m2,
                                    squared(config.heading_noise_rad));
  geometry::Matrix3 noise = duration_s / 3.0 * step_by_velocity *
                            velocity_walk(config).asDiagonal() * step_by_velocity.transpose();
  noise.diagonal() += of_any_step;
  return noise;
}

/// Velocity of a step by odometry, with its uncertainty.
void take_velocity(const geometry::UncertainPose2& step, double duration_s, MotionEstimate& after) {
  if (duration_s <= 0.0) return;
  after.velocity = {step.pose.x_m / duration_s, step.pose.heading_rad / duration_s};
  after.covariance.rightCols<2>().setZero();
  after.covariance.bottomRows<2>().setZero();
  after.covariance.bottomRightCorner<2, 2>().diagonal()
      << step.covariance(0, 0) / squared(duration_s),
      step.covariance(2, 2) / squared(duration_s);
}

void let_calibration_wander(double distance_m, double duration_s, const MotionModelConfig& config,
                            MotionEstimate& after) {
  after.covariance(3, 3) += squared(config.scale_walk_per_sqrt_m) * distance_m;
  after.covariance(4, 4) += squared(config.heading_rate_bias_walk) * duration_s;
  double& stamp_offset_s2 = after.covariance(kStampOffset, kStampOffset);
  const double least_known_s2 = std::max(stamp_offset_s2, squared(config.stamp_offset_prior_s));
  stamp_offset_s2 =
      std::min(least_known_s2, stamp_offset_s2 + squared(config.stamp_offset_walk) * duration_s);
}

/// Covariance of the step alone.
MotionEstimate moved(const MotionEstimate& before,
                     const geometry::UncertainPose2& before_from_base) {
  MotionEstimate after = before;
  after.odom_from_base = before.odom_from_base * before_from_base.pose;
  const geometry::Matrix3 by_before =
      geometry::compound_jacobian_first(before.odom_from_base, before_from_base.pose);
  const geometry::Matrix3 by_step = geometry::compound_jacobian_second(before.odom_from_base);
  after.covariance.topLeftCorner<3, 3>() =
      by_before * before.covariance.topLeftCorner<3, 3>() * by_before.transpose() +
      by_step * before_from_base.covariance * by_step.transpose();
  after.covariance.topRightCorner<3, kBesidesPose>() =
      by_before * before.covariance.topRightCorner<3, kBesidesPose>();
  after.covariance.bottomLeftCorner<kBesidesPose, 3>() =
      after.covariance.topRightCorner<3, kBesidesPose>().transpose();
  return after;
}

}  // namespace

MotionEstimate at_start(const MotionModelConfig& config) {
  MotionEstimate estimate;
  estimate.covariance.diagonal().tail<kBesidesPose>() << squared(config.scale_prior),
      squared(config.heading_rate_bias_prior_radps), squared(config.heading_per_metre_bias_prior),
      squared(config.pivot_prior_m), squared(config.pivot_prior_m),
      squared(config.stamp_offset_prior_s), squared(config.askew_prior_rad),
      squared(config.turn_factor_prior), squared(config.speed_prior_mps),
      squared(config.yaw_rate_prior_radps);
  return estimate;
}

bool is_pivot_certain(const MotionEstimate& estimate) {
  constexpr double kLeast_m = 0.05;
  constexpr double kSigmas = 4.0;
  const geometry::Vector2 pivot = pivot_m(estimate);
  const geometry::Matrix2 covariance = estimate.covariance.block<2, 2>(kPivot, kPivot);
  return pivot.norm() > kLeast_m && pivot.dot(covariance.ldlt().solve(pivot)) > kSigmas * kSigmas;
}

MotionEstimate with_pivot_of(MotionEstimate estimate, const MotionEstimate& other) {
  constexpr double kLearnedBeside_m = 0.1;  // one sigma: it was matched to a map that was made
                                            // without it
  estimate.calibration.segment<2>(kPivot - 3) = pivot_m(other);
  estimate.covariance.middleRows<2>(kPivot).setZero();
  estimate.covariance.middleCols<2>(kPivot).setZero();
  estimate.covariance.block<2, 2>(kPivot, kPivot) =
      other.covariance.block<2, 2>(kPivot, kPivot) +
      squared(kLearnedBeside_m) * geometry::Matrix2::Identity();
  return estimate;
}

geometry::UncertainPose2 predict_step(const Pose2& before_from_base_by_wheels, double duration_s,
                                      const MotionCalibration& calibration,
                                      const MotionModelConfig& config) {
  const Pose2& wheels = before_from_base_by_wheels;
  const double distance_m = std::hypot(wheels.x_m, wheels.y_m);
  const double turn_bias_rad = turn_bias(wheels, duration_s, calibration);
  // Half of the missing turn belongs to the first half of the step.
  const geometry::Vector2 moved_m =
      geometry::rotation(askew_rad(calibration) + 0.5 * turn_bias_rad) * wheels.translation_m() *
          (1.0 + calibration.x()) +
      swing(wheels.heading_rad + turn_bias_rad) * calibration.segment<2>(3);
  geometry::UncertainPose2 step;
  step.pose = {moved_m.x(), moved_m.y(), geometry::wrap_angle(wheels.heading_rad + turn_bias_rad)};
  const double ahead_m = config.position_noise_m + distance_m * config.position_noise_per_m;
  const double sideways_m = config.position_noise_m + distance_m * config.sideways_noise_per_m;
  const double heading_rad = config.heading_noise_rad + config.heading_noise_per_m * distance_m +
                             config.heading_noise_per_rad * std::abs(wheels.heading_rad);
  step.covariance.diagonal() << squared(ahead_m), squared(sideways_m), squared(heading_rad);
  return step;
}

MotionEstimate moved_by_wheels(const MotionEstimate& before, const WheelStep& by_wheels,
                               const MotionModelConfig& config) {
  geometry::UncertainPose2 step =
      predict_step(by_wheels.before_from_base, by_wheels.duration_s, before.calibration, config);
  step.covariance(2, 2) += by_wheels.turn_variance_rad2;
  MotionEstimate after = moved(before, step);
  const ByCalibration by_calibration = geometry::compound_jacobian_second(before.odom_from_base) *
                                       step_by_calibration(by_wheels, before.calibration);
  const ByCalibration cross = after.covariance.block<3, kCalibrations>(0, 3);
  const Eigen::Matrix<double, kCalibrations, kCalibrations> of_calibration =
      before.covariance.block<kCalibrations, kCalibrations>(3, 3);
  const geometry::Matrix3 mixed = by_calibration * cross.transpose();
  after.covariance.topLeftCorner<3, 3>() +=
      by_calibration * of_calibration * by_calibration.transpose() + mixed + mixed.transpose();
  after.covariance.block<3, kCalibrations>(0, 3) += by_calibration * of_calibration;
  after.covariance.block<kCalibrations, 3>(3, 0) =
      after.covariance.block<3, kCalibrations>(0, 3).transpose();
  let_calibration_wander(std::hypot(by_wheels.before_from_base.x_m, by_wheels.before_from_base.y_m),
                         by_wheels.duration_s, config, after);
  take_velocity(step, by_wheels.duration_s, after);
  return after;
}

MotionEstimate stood_still(const MotionEstimate& before, double duration_s,
                           const MotionModelConfig& config) {
  geometry::UncertainPose2 step;
  const double position_m2 = squared(config.standing_noise_m_per_sqrt_s) * duration_s;
  step.covariance.diagonal() << position_m2, position_m2,
      squared(config.standing_noise_rad_per_sqrt_s) * duration_s;
  MotionEstimate after = moved(before, step);
  let_calibration_wander(0.0, duration_s, config, after);
  take_velocity(step, duration_s, after);
  return after;
}

MotionEstimate moved_at_velocity(const MotionEstimate& before, double duration_s,
                                 const MotionModelConfig& config) {
  const double distance_m = before.velocity.x() * duration_s;
  const double turn_rad = before.velocity.y() * duration_s;
  const Eigen::Vector2d ahead(std::cos(0.5 * turn_rad), std::sin(0.5 * turn_rad));
  Matrix32 by_velocity;
  by_velocity << ahead.x(), -0.5 * distance_m * ahead.y(), ahead.y(), 0.5 * distance_m * ahead.x(),
      0.0, 1.0;
  by_velocity *= duration_s;
  const geometry::UncertainPose2 step{
      {distance_m * ahead.x(), distance_m * ahead.y(), geometry::wrap_angle(turn_rad)},
      noise_at_velocity(by_velocity, duration_s, before.velocity.y(), config)};
  const geometry::Matrix3 by_step = geometry::compound_jacobian_second(before.odom_from_base);
  MotionCovariance F = MotionCovariance::Identity();
  F.topLeftCorner<3, 3>() = geometry::compound_jacobian_first(before.odom_from_base, step.pose);
  F.topRightCorner<3, 2>() = by_step * by_velocity;
  MotionEstimate after = before;
  after.odom_from_base = before.odom_from_base * step.pose;
  after.covariance = F * before.covariance * F.transpose();
  after.covariance.topLeftCorner<3, 3>() += by_step * step.covariance * by_step.transpose();
  const Eigen::Vector2d walk = velocity_walk(config);
  after.covariance.bottomRightCorner<2, 2>().diagonal() += duration_s * walk;
  const Matrix32 cross = 0.5 * duration_s * by_step * by_velocity * walk.asDiagonal();
  after.covariance.topRightCorner<3, 2>() += cross;
  after.covariance.bottomLeftCorner<2, 3>() += cross.transpose();
  return after;
}

MotionEstimate with_doubted_velocity(const MotionEstimate& estimate, const Velocity& off) {
  MotionEstimate doubted = estimate;
  doubted.covariance.bottomRightCorner<2, 2>().diagonal() += off.cwiseAbs2();
  return doubted;
}

MotionEstimate matched(const MotionEstimate& predicted,
                       const geometry::UncertainPose2& odom_from_base) {
  MotionEstimate estimate = predicted;
  estimate.odom_from_base = odom_from_base.pose;
  const geometry::Matrix3 prior = predicted.covariance.topLeftCorner<3, 3>();
  const ByAllBesidesPose cross = predicted.covariance.topRightCorner<3, kBesidesPose>();
  const Eigen::Vector3d surprise =
      geometry::difference(odom_from_base.pose, predicted.odom_from_base);
  const Eigen::LDLT<geometry::Matrix3> factors(prior);
  const bool is_credible = surprise.dot(factors.solve(surprise)) < kSurprise;
  Eigen::Matrix<double, kBesidesPose, 3> gain = Eigen::Matrix<double, kBesidesPose, 3>::Zero();
  if (is_credible) gain = factors.solve(cross).transpose();
  estimate.calibration += gain.topRows<kCalibrations>() * surprise;
  estimate.velocity += gain.bottomRows<2>() * surprise;
  estimate.covariance.topLeftCorner<3, 3>() = odom_from_base.covariance;
  estimate.covariance.bottomLeftCorner<kBesidesPose, 3>() = gain * odom_from_base.covariance;
  estimate.covariance.topRightCorner<3, kBesidesPose>() =
      estimate.covariance.bottomLeftCorner<kBesidesPose, 3>().transpose();
  estimate.covariance.bottomRightCorner<kBesidesPose, kBesidesPose>() -=
      gain * (prior - odom_from_base.covariance) * gain.transpose();
  return estimate;
}

MotionEstimate against_renewed_map(const MotionEstimate& estimate, double renewed_share) {
  MotionEstimate renewed = estimate;
  renewed.covariance.block<3, kCalibrations>(0, 3) *= 1.0 - renewed_share;
  renewed.covariance.block<kCalibrations, 3>(3, 0) *= 1.0 - renewed_share;
  return renewed;
}

geometry::UncertainPose2 matched_from(const geometry::UncertainPose2& other_prediction,
                                      const geometry::UncertainPose2& prediction,
                                      const geometry::UncertainPose2& match) {
  const geometry::Matrix3 of_match = match.covariance.inverse();
  const geometry::Matrix3 of_scan = of_match - prediction.covariance.inverse();
  const Eigen::Vector3d scan_vector = of_match * geometry::difference(match.pose, prediction.pose);
  const geometry::Matrix3 covariance = (other_prediction.covariance.inverse() + of_scan).inverse();
  const Eigen::Vector3d change =
      covariance *
      (scan_vector - of_scan * geometry::difference(other_prediction.pose, prediction.pose));
  const Pose2& before = other_prediction.pose;
  return {{before.x_m + change.x(), before.y_m + change.y(),
           geometry::wrap_angle(before.heading_rad + change.z())},
          0.5 * (covariance + covariance.transpose())};
}

MotionEstimate put_at(const MotionEstimate& estimate,
                      const geometry::UncertainPose2& odom_from_base) {
  MotionEstimate put = estimate;
  put.odom_from_base = odom_from_base.pose;
  put.covariance.topRows<3>().setZero();
  put.covariance.leftCols<3>().setZero();
  put.covariance.topLeftCorner<3, 3>() = odom_from_base.covariance;
  return put;
}

}  // namespace slammot::sensing
