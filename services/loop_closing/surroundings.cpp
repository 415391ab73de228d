#include "services/loop_closing/surroundings.hpp"

namespace slammot::loop_closing {
namespace {

/// Submaps of a few metres with cells of 5 cm.
void set_building(LoopClosingConfig& config) {
  config.place.tolerance_m = 0.15;
  config.revisit.max_window_m = 12.0;
  config.revisit.astray_window_m = 20.0;
  config.revisit.registration.fine_gate_m = 0.2;
  config.revisit.registration.surfel_sigma_m = 0.04;
}

void set_streets(LoopClosingConfig& config) {
  const LoopClosingConfig defaults;
  config.place.tolerance_m = defaults.place.tolerance_m;
  config.revisit.max_window_m = defaults.revisit.max_window_m;
  config.revisit.astray_window_m = defaults.revisit.astray_window_m;
  config.revisit.registration.fine_gate_m = defaults.revisit.registration.fine_gate_m;
  config.revisit.registration.surfel_sigma_m = defaults.revisit.registration.surfel_sigma_m;
}

}  // namespace

void set_surroundings(LoopClosingConfig& config, Surroundings surroundings) {
  config.surroundings = surroundings;
  switch (surroundings) {
    case Surroundings::streets: set_streets(config); break;
    case Surroundings::building: set_building(config); break;
  }
}

}  // namespace slammot::loop_closing
