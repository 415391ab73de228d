#include "services/simulator/simulate_command.hpp"

#include <iomanip>
#include <iostream>
#include <memory>
#include <sstream>
#include <vector>

#include <CLI/CLI.hpp>

#include "services/simulator/drive_files.hpp"
#include "services/simulator/scenario_files.hpp"

namespace slammot::simulator {
namespace {

void list_scenarios(std::ostream& out) {
  for (const std::string& name : scenario_names()) {
    const auto scenario = load_scenario(name);
    out << std::left << std::setw(24) << name
        << (scenario ? scenario->description : scenario.error().message) << '\n';
  }
}

/// One scenario for each vehicle with scanners: NAME, NAME.2 and so on.
std::vector<simulation::ScenarioConfig> drives_of(const simulation::ScenarioConfig& scenario) {
  std::vector<simulation::ScenarioConfig> drives{scenario};
  if (scenario.place != simulation::Place::script || scenario.ride != 0) return drives;
  for (const simulation::ScriptedObject& object : scenario.script.objects) {
    if (!object.carries_scanner) continue;
    drives.push_back(scenario);
    drives.back().ride = static_cast<int>(drives.size()) - 1;
    drives.back().name += "." + std::to_string(drives.size());
  }
  return drives;
}

std::string describe(const simulation::ScenarioConfig& scenario, const DriveFiles& files) {
  std::ostringstream text;
  std::string more;
  for (const auto& path : files.more_sensors) more += ", " + path.filename().string();
  text << "simulated " << scenario.name << " (seed " << scenario.seed << "): " << files.scans
       << " scans, " << std::fixed << std::setprecision(0) << files.distance_m << " m\n  log    "
       << files.log.string() << more << "\n  truth  " << files.tum.string() << ", "
       << files.objects.filename().string() << ", " << files.walls.filename().string() << '\n';
  return text.str();
}

}  // namespace

int simulate(const SimulateOptions& options, std::ostream& out, std::ostream& err) {
  if (options.list) {
    list_scenarios(out);
    return 0;
  }
  const auto scenario = load_scenario(options.scenario, options.seed);
  if (!scenario) {
    err << "slammot simulate: " << scenario.error().message << '\n';
    return 1;
  }
  if (options.output.empty()) {
    err << "slammot simulate: --output DIR is required\n";
    return 1;
  }
  for (const simulation::ScenarioConfig& drive : drives_of(*scenario)) {
    const DriveFilesOrFault written =
        write_drive(drive, options.output, options.hits ? HitsFile::written : HitsFile::left_out);
    if (!written.files) {
      err << "slammot simulate: " << written.fault << '\n';
      return 1;
    }
    out << describe(drive, *written.files);
  }
  return 0;
}

void add_simulate_command(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<SimulateOptions>();
  CLI::App* command =
      app.add_subcommand("simulate", "Simulate a drive and write its log and ground truth");
  command->add_flag("--list", options->list, "List the scenarios");
  command->add_option("scenario", options->scenario, "Name of the scenario, or a file");
  command->add_option("--seed", options->seed,
                      "Seed of world, traffic and noise; default: the scenario's own");
  command->add_option("--output", options->output,
                      "Folder for NAME.log, .tum, .objects.csv and .walls.csv");
  command->add_flag("--hits", options->hits,
                    "Also write NAME.hits.csv: the object that each beam hit");
  command->callback(
      [options, &exit_code] { exit_code = simulate(*options, std::cout, std::cerr); });
}

}  // namespace slammot::simulator
