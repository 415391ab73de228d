#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/files/result.hpp"
#include "common/simulation/scenario.hpp"

namespace slammot::simulator {

/// The scenario in a file: by name of a shipped one or by path, with its own seed or with another.
/// The fault is one line, with the line and column where there is one.
files::Result<simulation::ScenarioConfig> load_scenario(
    const std::string& name_or_path, std::optional<std::uint64_t> seed = std::nullopt);

/// What no single setting shows, such as a way that leaves the city; empty when the scenario can be
/// driven.
std::optional<std::string> find_fault(const simulation::ScenarioConfig& scenario);

/// Names that load_scenario() knows, sorted.
std::vector<std::string> scenario_names();

}  // namespace slammot::simulator
