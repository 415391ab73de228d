#include "common/simulation/compass.hpp"

#include <cmath>

namespace slammot::simulation {

Compass::Compass(const CompassConfig& config, std::uint64_t seed)
    : config_(config),
      random_(seed, Purpose::compass),
      bias_rad_(config.bias_sigma_rad * random_.normal()),
      disturbance_(random_) {}

sensing::CompassReading Compass::reading(const geometry::Pose2& world_from_base, double moved_m) {
  disturbance_.advance(moved_m, config_.disturbance_length_m, random_);
  const double error_rad = bias_rad_ + config_.disturbance_rad * disturbance_.value() +
                           config_.noise_rad * random_.normal();
  sensing::CompassReading reading;
  reading.heading_from_east_rad = geometry::wrap_angle(world_from_base.heading_rad + error_rad);
  reading.sigma_rad =
      std::hypot(config_.noise_rad, config_.bias_sigma_rad, config_.disturbance_rad);
  return reading;
}

}  // namespace slammot::simulation
