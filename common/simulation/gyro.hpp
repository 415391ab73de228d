#pragma once

#include <cstdint>

#include "common/sensing/aids.hpp"
#include "common/simulation/random.hpp"

namespace slammot::simulation {

/// Gyro of an IMU about the vehicle's vertical axis.
struct ImuConfig {
  double rate_hz = 0.0;            ///< 0: there is none.
  double noise_radps = 0.003;      ///< Of each reading, one sigma.
  double bias_sigma_radps = 0.01;  ///< Drawn once a drive;
  double bias_walk_radps = 1e-4;   ///< from there it wanders by this in a second.
  double scale_sigma = 0.003;      ///< Of the factor on the turn rate; drawn once a drive.
};

class Gyro {
 public:
  Gyro(const ImuConfig& config, std::uint64_t seed);

  /// Reading this long after the last one.
  sensing::TurnRate reading(double yaw_rate_radps, double duration_s);

 private:
  ImuConfig config_;
  Random random_;
  double bias_radps_;
  double scale_;
};

}  // namespace slammot::simulation
