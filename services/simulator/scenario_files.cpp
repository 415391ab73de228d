#include "services/simulator/scenario_files.hpp"

#include <algorithm>
#include <set>

#include "common/config/overlay.hpp"
#include "common/config/profiles.hpp"
#include "services/simulator/scenario_fields.hpp"
#include "services/simulator/sumo_traffic.hpp"

namespace slammot::simulator {
namespace {

constexpr std::size_t kMaxIdSize = 32;  // Capacity of a scanner id on the bus, with its terminator.

using simulation::JunctionId;
using simulation::ScenarioConfig;
using simulation::ScriptedObject;

std::optional<std::string> find_fault_of_route(const std::vector<JunctionId>& corners,
                                               const simulation::CityConfig& city,
                                               const std::string& name) {
  const std::vector<JunctionId> way = along_streets(corners);
  for (std::size_t i = 0; i < way.size(); ++i) {
    if (way[i].column > city.blocks_east || way[i].row > city.blocks_north)
      return name + " leaves the city";
    if (i > 1 && way[i] == way[i - 2]) return name + " turns back in a street";
  }
  return std::nullopt;
}

std::optional<std::string> find_fault_of_object(const ScriptedObject& object,
                                                const std::string& name) {
  if (object.way.empty()) return name + " has no path";
  const auto same_place = [](const auto& a, const auto& b) {
    return a.x_m == b.x_m && a.y_m == b.y_m;
  };
  if (std::adjacent_find(object.way.begin(), object.way.end(), same_place) != object.way.end())
    return name + " has two equal consecutive points on its path";
  const auto not_later = [](const auto& a, const auto& b) { return a.at_s >= b.at_s; };
  if (std::adjacent_find(object.speed.begin(), object.speed.end(), not_later) != object.speed.end())
    return name + " has speeds whose times do not ascend";
  return std::nullopt;
}

std::optional<std::string> find_fault_of_scanners(const ScenarioConfig& scenario) {
  std::set<std::string> ids;
  for (std::size_t i = 0; i <= scenario.more_scanners.size(); ++i) {
    const simulation::ScannerConfig& scanner = scenario.scanner_at(i);
    const bool can_be_named = !scanner.scanner_id.empty() &&
                              scanner.scanner_id.size() < kMaxIdSize &&
                              scanner.scanner_id.find_first_of("/ ,") == std::string::npos;
    if (!can_be_named)
      return "scanner " + std::to_string(i + 1) +
             " needs a scanner_id of at most 31 characters without blank, comma and slash";
    if (!ids.insert(scanner.scanner_id).second)
      return "two scanners are named '" + scanner.scanner_id + "'";
    if (scanner.sweep_s * scanner.rate_hz > 1.0)
      return "the sweep of a scanner is longer than its period";
  }
  return std::nullopt;
}

/// Reads the recorded traffic that the scenario names, if any.
std::optional<files::Error> add_recorded_traffic(ScenarioConfig& scenario,
                                                 const std::filesystem::path& folder) {
  if (scenario.sumo_fcd.empty()) return std::nullopt;
  auto recorded = read_sumo_traffic(folder / scenario.sumo_fcd);
  if (!recorded) return recorded.error();
  simulation::ScriptConfig& script = scenario.script;
  script.recorded = std::move(*recorded);
  if (scenario.sumo_vehicle.empty()) return std::nullopt;
  const auto vehicle =
      std::ranges::find(script.recorded, scenario.sumo_vehicle, &simulation::RecordedObject::name);
  if (vehicle == script.recorded.end())
    return files::Error{scenario.sumo_fcd + ": no object is named '" + scenario.sumo_vehicle + "'"};
  script.recorded_vehicle = static_cast<int>(vehicle - script.recorded.begin());
  return std::nullopt;
}

std::optional<std::string> find_fault_of_script(const simulation::ScriptConfig& script) {
  if (script.recorded_vehicle < 0) {
    if (auto fault = find_fault_of_object(script.vehicle, "the vehicle")) return fault;
  }
  if (script.vehicle.copies != 1) return "the vehicle cannot have copies";
  for (std::size_t i = 0; i < script.objects.size(); ++i) {
    if (auto fault = find_fault_of_object(script.objects[i], "object " + std::to_string(i + 1)))
      return fault;
  }
  return std::nullopt;
}

files::Error unknown_scenario(const std::string& name) {
  return {"no scenario is named '" + name + "'; " +
          (scenario_names().empty() ? config::names_or_folders(config::kScenarios)
                                    : "slammot simulate --list names them")};
}

}  // namespace

std::optional<std::string> find_fault(const ScenarioConfig& scenario) {
  const auto not_further = [](const auto& a, const auto& b) { return a.x_m >= b.x_m; };
  if (std::ranges::adjacent_find(scenario.terrain, not_further) != scenario.terrain.end())
    return "the points of the terrain do not ascend from west to east";
  if (auto fault = find_fault_of_scanners(scenario)) return fault;
  switch (scenario.place) {
    case simulation::Place::city: {
      auto fault =
          find_fault_of_route(scenario.route.junctions, scenario.city, "the vehicle's route");
      return fault ? fault
                   : find_fault_of_route(scenario.traffic.car_ahead, scenario.city,
                                         "the route of the car ahead");
    }
    case simulation::Place::office: {
      const bool is_inside = std::ranges::all_of(scenario.robot_way, [&](const auto& corner) {
        return corner.column <= scenario.office.cross_corridors + 1;
      });
      return scenario.robot_way.size() < 2 || !is_inside
                 ? std::optional<std::string>(
                       "the robot's path has less than two corners, or leaves the office")
                 : std::nullopt;
    }
    case simulation::Place::script: break;
  }
  return find_fault_of_script(scenario.script);
}

std::optional<files::Error> find_fault_of_name(const std::string& name_or_path) {
  if (config::find_file(config::kScenarios, name_or_path)) return std::nullopt;
  return unknown_scenario(name_or_path);
}

files::Result<ScenarioConfig> load_scenario(const std::string& name_or_path,
                                            std::optional<std::uint64_t> seed) {
  const auto file = config::find_file(config::kScenarios, name_or_path);
  if (!file) return unknown_scenario(name_or_path);
  ScenarioConfig scenario;
  if (const auto fault = config::overlay_message_file(
          *file, config::bind_stage("Scenario", scenario_fields(), scenario))) {
    return files::Error{fault->text()};
  }
  if (const auto fault = add_recorded_traffic(scenario, file->parent_path())) return *fault;
  if (const auto fault = find_fault(scenario)) return files::Error{file->string() + ": " + *fault};
  scenario.name = file->stem().string();
  scenario.seed = seed.value_or(scenario.seed);
  return scenario;
}

std::vector<std::string> scenario_names() { return config::names_on(config::kScenarios); }

}  // namespace slammot::simulator
