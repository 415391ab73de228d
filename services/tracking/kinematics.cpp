#include "services/tracking/kinematics.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::tracking {

using Eigen::Matrix2d;
using Eigen::Vector2d;

namespace {

constexpr double kMeanStayS = 3.0;  ///< Mean time in one mode: docs/decisions/motion-models.md.
constexpr double kTurnNoiseDensity = 3.0;  ///< Of the coordinated turn [m^2/s^5].

}  // namespace

filters::ModelSet motion_models(const TrackingConfig& config) {
  filters::ModelSet set;
  set.models[0] = {filters::MotionKind::kConstantVelocity, config.motion.velocity_noise_density,
                   kIdleAccelerationMps2};
  set.models[1] = {filters::MotionKind::kConstantAcceleration, kJerkNoiseDensity, 0.0};
  set.size = 2;
  set.mean_stay_s = kMeanStayS;
  set.mixture = config.motion.mixture;
  return set;
}

filters::ModelSet models_of(const Kinematics& kinematics, const TrackingConfig& config) {
  filters::ModelSet set = motion_models(config);
  if (kinematics.cruises_only) set.size = 1;
  if (kinematics.may_turn)
    set.models[set.size++] = {filters::MotionKind::kCoordinatedTurn, kTurnNoiseDensity, 0.0};
  return set;
}

double speed_sigma_mps(const Kinematics& kinematics) {
  return std::sqrt(0.5 * kinematics.velocity_covariance().trace());
}

Course course_of(const Kinematics& kinematics) {
  const Vector2d velocity = kinematics.velocity_mps();
  const double speed2 = std::max(velocity.squaredNorm(), 1e-6);
  const Vector2d across{-velocity.y(), velocity.x()};
  return {std::atan2(velocity.y(), velocity.x()),
          across.dot(kinematics.velocity_covariance() * across) / (speed2 * speed2)};
}

void predict(Kinematics& kinematics, double time_s, const TrackingConfig& config) {
  const filters::ModelSet models = models_of(kinematics, config);
  kinematics.mixture = filters::imm_predict(models, kinematics.mixture, time_s);
  kinematics.estimate = filters::imm_combine(models, kinematics.mixture);
}

void combine(Kinematics& kinematics, const TrackingConfig& config) {
  kinematics.estimate = filters::imm_combine(models_of(kinematics, config), kinematics.mixture);
}

void shift(Kinematics& kinematics, const Vector2d& by_m, const TrackingConfig& config) {
  filters::imm_shift(models_of(kinematics, config), kinematics.mixture, by_m);
  filters::move_stop_shift(kinematics.move_stop, by_m);
  kinematics.recentred_m += by_m;
  if (kinematics.measured) kinematics.measured->centre_m += by_m;
}

void restart_from(Kinematics& kinematics, const filters::MotionState& state,
                  const TrackingConfig& config) {
  kinematics.mixture = filters::imm_start(motion_models(config), state);
  kinematics.may_turn = false;
  kinematics.cruises_only = false;
  kinematics.estimate = state;
}

void restart_velocity(Kinematics& kinematics, const Vector2d& velocity_mps, double sigma_mps,
                      const TrackingConfig& config) {
  filters::MotionState start;
  start.mean.head<2>() = kinematics.position_m();
  start.mean.segment<2>(2) = velocity_mps;
  start.covariance.topLeftCorner<2, 2>() = kinematics.position_covariance_m2();
  start.covariance.block<2, 2>(2, 2) = sigma_mps * sigma_mps * Matrix2d::Identity();
  start.covariance.block<2, 2>(4, 4) =
      kIdleAccelerationMps2 * kIdleAccelerationMps2 * Matrix2d::Identity();
  restart_from(kinematics, start, config);
}

void constrain_to_axis(Kinematics& kinematics, const AxisConstraint& constraint,
                       const TrackingConfig& config) {
  // An axis that no side measures now has the same error in all scans since one did: they count for
  // one in each interval.
  constexpr double kUnseenAxisS = 0.2;
  const double scans =
      constraint.is_measured_now ? 1.0 : std::max(1.0, kUnseenAxisS / constraint.time_s);
  const Vector2d across{-std::sin(constraint.axis_rad), std::cos(constraint.axis_rad)};
  const double variance = kinematics.velocity_mps().squaredNorm() *
                              (kSlip * kSlip + scans * constraint.axis_variance_rad2) +
                          std::pow(kSlipMps * config.extent.size_scale, 2);
  const filters::ModelSet models = models_of(kinematics, config);
  kinematics.mixture = filters::imm_update_speed(models, kinematics.mixture, across, 0.0, variance);
  kinematics.estimate = filters::imm_combine(models, kinematics.mixture);
}

}  // namespace slammot::tracking
