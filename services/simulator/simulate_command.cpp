#include "services/simulator/simulate_command.hpp"

#include <iomanip>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "services/simulator/drive_files.hpp"

namespace slammot::simulator {
namespace {

void list_scenarios(std::ostream& out) {
  for (const std::string& name : simulation::scenario_names()) {
    out << std::left << std::setw(14) << name << simulation::shipped_scenario(name)->description << '\n';
  }
}

}  // namespace

int simulate(const SimulateOptions& options, std::ostream& out, std::ostream& err) {
  if (options.list) {
    list_scenarios(out);
    return 0;
  }
  const auto scenario = simulation::shipped_scenario(options.scenario, options.seed);
  if (!scenario) {
    err << "slammot simulate: no scenario is named '" << options.scenario << "'; --list names them\n";
    return 1;
  }
  if (options.output.empty()) {
    err << "slammot simulate: say where to write with --output DIR\n";
    return 1;
  }
  const DriveFilesOrFault written = write_drive(*scenario, options.output);
  if (!written.files) {
    err << "slammot simulate: " << written.fault << '\n';
    return 1;
  }
  out << "simulated " << scenario->name << " (seed " << scenario->seed << "): " << written.files->scans << " scans, "
      << std::fixed << std::setprecision(0) << written.files->distance_m << " m\n"
      << "  log    " << written.files->log.string() << '\n'
      << "  truth  " << written.files->tum.string() << ", " << written.files->objects.filename().string() << ", "
      << written.files->walls.filename().string() << '\n';
  return 0;
}

void add_simulate_command(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<SimulateOptions>();
  CLI::App* command = app.add_subcommand("simulate", "Make a drive through a simulated world, with its truth");
  command->add_flag("--list", options->list, "Name the scenarios");
  command->add_option("scenario", options->scenario, "Name of the scenario");
  command->add_option("--seed", options->seed, "Other world, traffic and noise than the scenario's own");
  command->add_option("--output", options->output, "Folder for NAME.log, .tum, .objects.csv and .walls.csv");
  command->callback([options, &exit_code] { exit_code = simulate(*options, std::cout, std::cerr); });
}

}  // namespace slammot::simulator
