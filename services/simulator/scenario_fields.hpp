#pragma once

#include "common/config/fields.hpp"
#include "common/simulation/scenario.hpp"

namespace slammot::simulator {

/// Everything that a scenario file may set; `Scenario` in scenario.proto.
config::FieldTable<simulation::ScenarioConfig> scenario_fields();

}  // namespace slammot::simulator
