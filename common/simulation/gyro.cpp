#include "common/simulation/gyro.hpp"

#include <cmath>

namespace slammot::simulation {

Gyro::Gyro(const ImuConfig& config, std::uint64_t seed)
    : config_(config),
      random_(seed, Purpose::imu),
      bias_radps_(config.bias_sigma_radps * random_.normal()),
      scale_(1.0 + config.scale_sigma * random_.normal()) {}

sensing::TurnRate Gyro::reading(double yaw_rate_radps, double duration_s) {
  bias_radps_ += config_.bias_walk_radps * std::sqrt(duration_s) * random_.normal();
  return {.yaw_rate_radps =
              scale_ * yaw_rate_radps + bias_radps_ + config_.noise_radps * random_.normal()};
}

}  // namespace slammot::simulation
