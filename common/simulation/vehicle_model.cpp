#include "common/simulation/vehicle_model.hpp"

#include <cmath>
#include <numbers>

namespace slammot::simulation {

using geometry::Pose2;

double Suspension::advance(double acceleration_mps2, double dt_s) {
  const double rest_rad = -config_.pitch_per_mps2_rad * acceleration_mps2;
  const double omega = 2.0 * std::numbers::pi * config_.frequency_hz;
  const double pull = omega * omega * (rest_rad - nose_down_rad_) -
                      2.0 * config_.damping_ratio * omega * nose_down_radps_;
  nose_down_radps_ += pull * dt_s;  // semi-implicit Euler: stable at the simulator's steps
  nose_down_rad_ += nose_down_radps_ * dt_s;
  return nose_down_rad_;
}

WheelOdometer::WheelOdometer(const OdometryConfig& config, std::uint64_t seed)
    : config_(config), random_(seed, Purpose::odometry) {
  const double error = random_.uniform(config.scale_error_low, config.scale_error_high);
  scale_ = 1.0 + (random_.chance(0.5) ? error : -error);
  rate_bias_radps_ = config.rate_bias_sigma_radps * random_.normal();
}

void WheelOdometer::advance(const Pose2& before_from_after, double dt_s) {
  const double true_distance_m = before_from_after.translation_m().norm();
  const bool moves = true_distance_m > 1e-6;
  const double distance_m =
      scale_ * true_distance_m * (1.0 + config_.distance_noise * random_.normal());
  const double noise_rad = (moves ? config_.heading_noise_rad : 0.0) * random_.normal();
  const double turn_rad = before_from_after.heading_rad + rate_bias_radps_ * dt_s + noise_rad;
  rate_bias_radps_ += config_.rate_bias_walk_radps * std::sqrt(dt_s) * random_.normal();
  // Along the arc's chord, which leaves at half the turn.
  wheel_from_base_ = wheel_from_base_ * Pose2{distance_m * std::cos(0.5 * turn_rad),
                                              distance_m * std::sin(0.5 * turn_rad), turn_rad};
  speed_mps_ = distance_m / dt_s;
  yaw_rate_radps_ = turn_rad / dt_s;
}

}  // namespace slammot::simulation
