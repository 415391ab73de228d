#include "services/simulator/simulate_command.hpp"

#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <sstream>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/files/atomic_file.hpp"
#include "common/files/number_option.hpp"
#include "common/files/street_file.hpp"
#include "common/simulation/path.hpp"
#include "common/simulation/street_plan.hpp"
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

std::optional<files::Error> find_usage_fault(const SimulateOptions& options) {
  if (auto fault = find_fault_of_name(options.scenario)) return fault;
  if (options.output.empty()) return files::Error{"--output DIR is required"};
  return std::nullopt;
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

/// The city's streets, a street for each side of a block, named by the junctions at its ends:
/// "1,1-2,1" (column, row).
files::Result<streets::StreetGraph> streets_of(const simulation::ScenarioConfig& scenario,
                                               const std::string& left_out) {
  constexpr double kSpacing_m = 10.0;
  if (scenario.place != simulation::Place::city)
    return files::Error{"--streets: the scenario is no city"};
  const simulation::StreetPlan plan(scenario.city, scenario.seed);
  streets::StreetGraph graph{{scenario.gnss.latitude_deg, scenario.gnss.longitude_deg}, {}};
  bool is_known = left_out.empty();
  for (int i = 0; i < plan.junction_count(); ++i) {
    const simulation::JunctionId from = plan.junction(i);
    for (const auto direction : {simulation::Direction::east, simulation::Direction::north}) {
      const auto to = plan.neighbour(from, direction);
      if (!to) continue;
      const std::string name = std::to_string(from.column) + "," + std::to_string(from.row) + "-" +
                               std::to_string(to->column) + "," + std::to_string(to->row);
      is_known = is_known || name == left_out;
      if (name == left_out) continue;
      graph.streets.push_back(
          {name, plan.world_from_plan(simulation::line(plan.junction_in_plan(from),
                                                       plan.junction_in_plan(*to), kSpacing_m))});
    }
  }
  if (!is_known) return files::Error{"--without-street " + left_out + ": no such street"};
  return graph;
}

/// Writes NAME.streets.geojson. Returns the reason if it cannot.
std::optional<files::Error> write_streets(const simulation::ScenarioConfig& scenario,
                                          const SimulateOptions& options) {
  const auto graph = streets_of(scenario, options.without_street);
  if (!graph) return graph.error();
  if (auto fault = files::prepare_output_folder(options.output)) return fault;
  return files::write_file_atomically(
      std::filesystem::path(options.output) / (scenario.name + ".streets.geojson"),
      files::to_geojson(*graph));
}

}  // namespace

int simulate(const SimulateOptions& options, std::ostream& out, std::ostream& err) {
  if (options.list) {
    list_scenarios(out);
    return 0;
  }
  if (const auto fault = find_usage_fault(options)) {
    err << "slammot simulate: " << fault->message << '\n';
    return 2;
  }
  const auto scenario = load_scenario(options.scenario, options.seed);
  if (!scenario) {
    err << "slammot simulate: " << scenario.error().message << '\n';
    return 1;
  }
  if (options.streets) {
    if (const auto fault = write_streets(*scenario, options)) {
      err << "slammot simulate: " << fault->message << '\n';
      return 1;
    }
    return 0;
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
  command
      ->add_option("--seed", options->seed,
                   "Seed of world, traffic and noise; default: the scenario's own")
      ->check(files::not_negative_number());
  command->add_option("--output", options->output,
                      "Folder for NAME.log, .tum, .objects.csv and .walls.csv");
  command->add_flag("--hits", options->hits,
                    "Also write NAME.hits.csv: the object that each beam hit");
  command->add_flag(
      "--streets", options->streets,
      "Write only NAME.streets.geojson: the street graph of a city, for run --streets");
  command->add_option("--without-street", options->without_street,
                      "Leave a street out of it, by its name in that file, for example 1,1-2,1");
  command->callback(
      [options, &exit_code] { exit_code = simulate(*options, std::cout, std::cerr); });
}

}  // namespace slammot::simulator
