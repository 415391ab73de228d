#include <algorithm>

#include <Eigen/LU>

#include "services/localization/odometry_prediction.hpp"

namespace slammot::localization {

/// Noise of the wheels' turns beyond that of sound wheels, of which the motion model has a multiple
/// so that the match dominates. Where scans come seldom, a step's turns are no noise.
double OdometryPrediction::turn_variance_rad2(double duration_s) const {
  constexpr double kSigmas = 3.0;
  constexpr double kSound = 0.5;  // of the noise that the motion model has for a step of any length
  if (sensing::wheels_tell_turns(state_.belief)) return 0.0;
  const double sound_rad = kSound * config_.motion.heading_noise_rad;
  const double beyond_rad2 = state_.turn_noise.variance_in(duration_s) - sound_rad * sound_rad;
  return kSigmas * kSigmas * std::max(0.0, beyond_rad2);
}

/// Where the wheels' turns are noise, the vehicle rather goes on to turn as it did: mean of both,
/// weighted by their information.
sensing::WheelStep OdometryPrediction::turned_as_likely(sensing::WheelStep by_wheels) const {
  if (by_wheels.turn_variance_rad2 == 0.0) return by_wheels;
  const sensing::OdometryBelief& belief = state_.belief;
  const double duration_s = by_wheels.duration_s;
  const double going_on_rad2 = belief.matched_velocity_variance.y() * duration_s * duration_s;
  const double share =
      by_wheels.turn_variance_rad2 / (by_wheels.turn_variance_rad2 + going_on_rad2);
  geometry::Pose2& step = by_wheels.before_from_base;
  const double more_rad =
      share * geometry::wrap_angle(belief.matched_velocity.y() * duration_s - step.heading_rad);
  const geometry::Vector2 moved_m = geometry::rotation(0.5 * more_rad) * step.translation_m();
  step = {moved_m.x(), moved_m.y(), step.heading_rad + more_rad};
  by_wheels.by_stamp_offset.z() *= 1.0 - share;
  by_wheels.turn_variance_rad2 = share * going_on_rad2;
  return by_wheels;
}

/// What scans say of the heading by themselves, beside the wheels' turns.
void OdometryPrediction::learn_turn_noise(const Step& step, const ScanMatch& match) {
  if (step.duration_s <= 0.0) return;
  if (!step.has_wheels() || step.wheels.is_standing || !match.is_believed || match.is_lost ||
      match.was_sampled) {
    state_.turn_noise.interrupt();
    return;
  }
  const geometry::Matrix3 by_scan =
      match.odom_from_base.covariance.inverse() - step.prior().covariance.inverse();
  const double turned_rad =
      sensing::corrected(step.wheels.uncorrected, step.duration_s, state_.belief.factors)
          .heading_rad;
  state_.turn_noise.add(
      sensing::scan_optimum(step.prior(), match.odom_from_base.pose, by_scan).heading_rad,
      turned_rad, step.duration_s);
}

}  // namespace slammot::localization
