#pragma once

#include "services/loop_closing/loop_closing_config.hpp"

namespace slammot::loop_closing {

/// Sets what depends on what submaps show: the width of searches for revisits, the tolerance of
/// walls, and the gate and noise of a registration. Surroundings::streets: the defaults.
void set_surroundings(LoopClosingConfig& config, Surroundings surroundings);

}  // namespace slammot::loop_closing
