#pragma once

#include <cstdint>

#include "common/sensing/aids.hpp"
#include "common/simulation/drifting_error.hpp"

namespace slammot::simulation {

/// A magnetic compass in a vehicle, in a world whose x goes east.
struct CompassConfig {
  double rate_hz = 0.0;               ///< 0: there is none.
  double noise_rad = 0.015;           ///< Of each reading, one sigma.
  double bias_sigma_rad = 0.03;       ///< By its mounting and the vehicle's own iron; drawn once a drive.
  double disturbance_rad = 0.05;      ///< By iron around the vehicle: one sigma, and
  double disturbance_length_m = 20.0; ///< alike over this way.
};

class Compass {
 public:
  Compass(const CompassConfig& config, std::uint64_t seed);

  /// So far after the last reading.
  sensing::CompassReading reading(const geometry::Pose2& world_from_base, double moved_m);

 private:
  CompassConfig config_;
  Random random_;
  double bias_rad_;
  DriftingError disturbance_;
};

}  // namespace slammot::simulation
