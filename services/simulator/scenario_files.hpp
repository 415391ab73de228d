#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/files/result.hpp"
#include "common/simulation/scenario.hpp"

namespace slammot::simulator {

/// Loads a scenario by the name of a shipped file or by path; `seed` replaces its seed. A fault is
/// one line, with line and column if they are known.
files::Result<simulation::ScenarioConfig> load_scenario(
    const std::string& name_or_path, std::optional<std::uint64_t> seed = std::nullopt);

/// Why a name means no scenario, in one line; nothing if it is that of a shipped one or of a file.
std::optional<files::Error> find_fault_of_name(const std::string& name_or_path);

/// Checks conditions across settings, such as a route that leaves the city; empty if the scenario
/// is valid.
std::optional<std::string> find_fault(const simulation::ScenarioConfig& scenario);

/// Names of shipped scenarios, sorted.
std::vector<std::string> scenario_names();

}  // namespace slammot::simulator
