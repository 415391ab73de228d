#pragma once

#include <cstdint>

#include "common/sensing/aids.hpp"
#include "common/simulation/drifting_error.hpp"

namespace slammot::simulation {

/// Magnetic compass of a vehicle; the world's x axis points east.
struct CompassConfig {
  double rate_hz = 0.0;          ///< 0: there is none.
  double noise_rad = 0.015;      ///< Of each reading, one sigma.
  double bias_sigma_rad = 0.03;  ///< Of the mounting and the vehicle's magnetic field; drawn once a
                                 ///< drive.
  double disturbance_rad = 0.05;       ///< Disturbance by iron in the surroundings, one sigma,
  double disturbance_length_m = 20.0;  ///< with this correlation length.
};

class Compass {
 public:
  Compass(const CompassConfig& config, std::uint64_t seed);

  /// Reading at this distance after the last one.
  sensing::CompassReading reading(const geometry::Pose2& world_from_base, double moved_m);

 private:
  CompassConfig config_;
  Random random_;
  double bias_rad_;
  DriftingError disturbance_;
};

}  // namespace slammot::simulation
