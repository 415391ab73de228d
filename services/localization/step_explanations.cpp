#include "services/localization/step_explanations.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::localization {
namespace {

using geometry::Matrix3;
using sensing::StepExplanation;

constexpr double kReachPerMetre = 0.5;  // What each metre by odometry adds to reach_m.
constexpr double kUsualReach = 0.7;     // Without odometry, what the usual step adds, as a share of
                                        // it.
constexpr double kRepeatShare = 0.25;  // One sigma of a step that is like one before, as a share of
                                       // it.
constexpr double kRepeat_m = 0.08;     // What is added to kRepeatShare of the step.
constexpr double kReach_rad = 0.6;     // Wheels that say nothing: one sigma of the heading.
constexpr double kReachPerRadian = 0.5;  // What each radian by odometry adds to kReach_rad.

constexpr double kLongestVelocity_s = 0.6;  // a robot starts, stops and turns within it

}  // namespace

bool has_velocity(const Step& step, const LocalizerConfig& config) {
  return config.odometry.time_is_known && step.usual_duration_s < kLongestVelocity_s;
}

double usual_duration_so_far_s(const Step& step, const sensing::OdometryBelief& belief,
                               const sensing::OdometryBeliefConfig& config) {
  const double share_of_start =
      std::pow(1.0 - config.usual_step_memory, static_cast<double>(belief.steps.size()));
  if (share_of_start == 1.0) return step.duration_s;
  return (belief.usual_step_s - share_of_start * sensing::OdometryBelief::kUsualStepAtStart_s) /
         (1.0 - share_of_start);
}

Step StepExplanations::without_odometry(Step step) const {
  const geometry::Pose2& last = belief_.last_step;
  const geometry::Pose2 half{0.5 * last.x_m, 0.5 * last.y_m, 0.5 * last.heading_rad};
  step.after = before_;
  step.after.odom_from_base = before_.odom_from_base * half;
  const double reach_m = config_.belief.reach_m + kUsualReach * belief_.usual_way_m;
  const double reach_rad = kReach_rad;
  step.after.covariance.topLeftCorner<3, 3>().diagonal() +=
      Eigen::Vector3d(reach_m, reach_m, reach_rad).cwiseAbs2();
  return step;
}

Step StepExplanations::about(Step step, const geometry::Pose2& before_from_base,
                             double sigma_rad) const {
  const double sigma_m = kRepeat_m + kRepeatShare * before_from_base.translation_m().norm();
  step.after = before_;
  step.after.odom_from_base = before_.odom_from_base * before_from_base;
  step.after.covariance.topLeftCorner<3, 3>().diagonal() +=
      Eigen::Vector3d(sigma_m, sigma_m, sigma_rad).cwiseAbs2();
  return step;
}

Step StepExplanations::rough(const Step& by_wheels) const {
  Step step = by_wheels;
  step.explanation = StepExplanation::kRoughWheels;
  step.wheels.are_overruled = true;
  const geometry::Pose2 corrected =
      sensing::corrected(by_wheels.wheels.uncorrected, by_wheels.duration_s, belief_.factors);
  const double more = config_.belief.rough_sigmas * config_.belief.rough_sigmas - 1.0;
  const Matrix3 by_step = geometry::compound_jacobian_second(before_.odom_from_base);
  const Matrix3 noise =
      sensing::predict_step(corrected, by_wheels.duration_s, before_.calibration, motion_)
          .covariance;
  step.after.covariance.topLeftCorner<3, 3>() += more * by_step * noise * by_step.transpose();
  return step;
}

std::optional<Step> StepExplanations::recalibrated(const Step& by_wheels) const {
  if (!belief_.estimator.is_known()) return std::nullopt;
  Step step = by_wheels;
  step.explanation = StepExplanation::kRecalibrated;
  step.wheels.are_overruled = true;
  step.wheels.is_standing = false;
  sensing::MotionEstimate before = before_;
  for (const int row : sensing::kWheelRows) before.calibration[row - 3] = 0.0;
  const geometry::Pose2 corrected = sensing::corrected(
      by_wheels.wheels.uncorrected, by_wheels.duration_s, belief_.estimator.factors());
  step.after = sensing::moved_by_wheels(before,
                                        {.before_from_base = corrected,
                                         .duration_s = by_wheels.duration_s,
                                         .by_stamp_offset = Eigen::Vector3d::Zero(),
                                         .turn_variance_rad2 = by_wheels.wheels.turn_variance_rad2},
                                        motion_);
  step.after.calibration = before_.calibration;
  return step;
}

Step StepExplanations::at_constant_velocity(Step step) const {
  sensing::MotionEstimate before = before_;
  if (belief_.last != StepExplanation::kOther) {  // then the velocity of the estimate is that of
                                                  // odometry
    before.velocity = belief_.matched_velocity;
    before.covariance.rightCols<2>().setZero();
    before.covariance.bottomRows<2>().setZero();
    before.covariance.bottomRightCorner<2, 2>().diagonal() = belief_.matched_velocity_variance;
  }
  step.after = sensing::moved_at_velocity(
      before, std::min(step.duration_s, config_.odometry.longest_step_s), config_.motion);
  step.source = StepSource::kVelocityAlone;
  return step;
}

Step StepExplanations::within_reach(Step step) const {
  const double way_m = std::hypot(step.before_from_base.x_m, step.before_from_base.y_m);
  const double reach_m = config_.belief.reach_m + kReachPerMetre * way_m;
  const double reach_rad =
      kReach_rad + kReachPerRadian * std::abs(step.before_from_base.heading_rad);
  step.after.covariance.topLeftCorner<3, 3>().diagonal() +=
      Eigen::Vector3d(reach_m, reach_m, reach_rad).cwiseAbs2();
  return step;
}

Step StepExplanations::other(const Step& by_wheels) const {
  Step step = by_wheels;
  step.explanation = StepExplanation::kOther;
  step.wheels.are_overruled = true;
  step.wheels.is_standing = false;
  step.wheels.stood_s = 0.0;
  return has_velocity(by_wheels, config_) ? at_constant_velocity(std::move(step))
                                          : within_reach(std::move(step));
}

}  // namespace slammot::localization
