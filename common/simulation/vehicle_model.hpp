#pragma once

#include <cstdint>

#include "common/geometry/pose2.hpp"
#include "common/simulation/random.hpp"

namespace slammot::simulation {

/// How the body pitches when the vehicle speeds up or brakes.
struct SuspensionConfig {
  double pitch_per_mps2_rad = 0.005;  ///< At rest under constant acceleration; 3 degrees a g, a
                                      ///< soft car.
  double frequency_hz = 1.4;
  double damping_ratio = 0.35;
};

/// What is wrong with the wheels and the rate gyro.
struct OdometryConfig {
  double scale_error_low = 0.006;  ///< Wheel size: constant of a drive, of either sign.
  double scale_error_high = 0.014;
  double distance_noise = 0.01;        ///< Of each step's length, one sigma.
  double heading_noise_rad = 0.00034;  ///< Of each step while moving, one sigma (0.0195 degrees).
  double rate_bias_sigma_radps = 0.0012;  ///< Heading rate at rest; drawn once a drive.
  double rate_bias_walk_radps = 0.00004;  ///< Its drift in one second, one sigma.
};

/// Damped spring that the body's pitch follows.
class Suspension {
 public:
  explicit Suspension(const SuspensionConfig& config) : config_(config) {}

  /// Pitch after dt_s under a forward acceleration; positive is nose down, as under braking.
  double advance(double acceleration_mps2, double dt_s);

 private:
  SuspensionConfig config_;
  double nose_down_rad_ = 0.0;
  double nose_down_radps_ = 0.0;
};

/// Dead reckoning from imperfect wheels and gyro.
class WheelOdometer {
 public:
  WheelOdometer(const OdometryConfig& config, std::uint64_t seed);

  /// Takes the true motion over one step of dt_s.
  void advance(const geometry::Pose2& before_from_after, double dt_s);

  const geometry::Pose2& wheel_from_base() const { return wheel_from_base_; }
  double speed_mps() const { return speed_mps_; }
  double yaw_rate_radps() const { return yaw_rate_radps_; }

 private:
  OdometryConfig config_;
  Random random_;
  double scale_ = 1.0;
  double rate_bias_radps_ = 0.0;
  geometry::Pose2 wheel_from_base_;
  double speed_mps_ = 0.0;
  double yaw_rate_radps_ = 0.0;
};

}  // namespace slammot::simulation
