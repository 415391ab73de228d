#pragma once

#include "common/config/fields.hpp"
#include "common/simulation/scenario.hpp"

namespace slammot::simulator {

/// All settings of a scenario file; `Scenario` in scenario.proto.
config::FieldTable<simulation::ScenarioConfig> scenario_fields();

}  // namespace slammot::simulator
