#include "common/simulation/scenario.hpp"

#include <algorithm>
#include <functional>

#include "common/simulation/random.hpp"

namespace slammot::simulation {
namespace {

/// Junctions along straight streets from corner to corner, each once, both ends included.
std::vector<JunctionId> along_streets(const std::vector<JunctionId>& corners) {
  std::vector<JunctionId> route{corners.front()};
  for (std::size_t i = 1; i < corners.size(); ++i) {
    while (!(route.back() == corners[i])) {
      JunctionId next = route.back();
      next.column += (corners[i].column > next.column) - (corners[i].column < next.column);
      if (next.column == route.back().column) next.row += (corners[i].row > next.row) - (corners[i].row < next.row);
      route.push_back(next);
    }
  }
  return route;
}

ScenarioConfig demo() {
  ScenarioConfig scenario;
  scenario.description = "once around a block and a little further, every kind of road user, 90 s";
  scenario.seed = 5;  // meets a bus, a truck, bicycles and a fright, and closes its loop
  scenario.duration_s = 90.0;
  scenario.city.blocks_east = 3;
  scenario.city.blocks_north = 3;
  scenario.city.block_pitch_m = 75.0;
  scenario.city.signalled_share = 0.3;
  scenario.traffic.cars = 30;
  scenario.traffic.buses = 2;
  scenario.traffic.bicycles = 8;
  scenario.traffic.car_ahead = along_streets({{0, 1}, {3, 1}});
  scenario.walkers.pedestrians = 90;
  scenario.route.junctions = along_streets({{0, 1}, {2, 1}, {2, 2}, {1, 2}, {1, 1}, {2, 1}, {2, 2}});
  scenario.route.start_m = 30.0;
  scenario.route.hard_brake_every_s = 15.0;
  return scenario;
}

ScenarioConfig city() {
  ScenarioConfig scenario;
  scenario.description = "crowded city, two loops with a shared street, 300 s";
  scenario.duration_s = 300.0;
  scenario.traffic.cars = 75;
  scenario.traffic.trucks = 6;
  scenario.traffic.buses = 6;
  scenario.traffic.bicycles = 18;
  scenario.walkers.pedestrians = 260;
  scenario.route.junctions = along_streets({{1, 1}, {2, 1}, {2, 2}, {1, 2}, {1, 1}, {3, 1}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}});
  return scenario;
}

ScenarioConfig quiet() {
  ScenarioConfig scenario;
  scenario.description = "little traffic, one long loop, 440 s";
  scenario.duration_s = 440.0;
  scenario.city.blocks_east = 6;
  scenario.city.blocks_north = 5;
  scenario.city.signalled_share = 0.4;
  scenario.traffic.cars = 22;
  scenario.traffic.trucks = 4;
  scenario.traffic.buses = 2;
  scenario.traffic.bicycles = 8;
  scenario.walkers.pedestrians = 90;
  scenario.route.junctions = along_streets({{1, 1}, {5, 1}, {5, 4}, {1, 4}, {1, 1}, {5, 1}, {5, 4}});
  scenario.route.speed_factor = 1.2;
  return scenario;
}

struct Shipped {
  std::string_view name;
  ScenarioConfig (*make)();
};
constexpr Shipped kShipped[] = {{"demo", demo}, {"city", city}, {"quiet", quiet}};

}  // namespace

std::vector<std::string> scenario_names() {
  std::vector<std::string> names;
  for (const Shipped& shipped : kShipped) names.emplace_back(shipped.name);
  return names;
}

std::optional<ScenarioConfig> shipped_scenario(std::string_view name, std::optional<std::uint64_t> seed) {
  for (const Shipped& shipped : kShipped) {
    if (shipped.name != name) continue;
    ScenarioConfig scenario = shipped.make();
    scenario.name = shipped.name;
    scenario.seed = seed.value_or(scenario.seed);
    return scenario;
  }
  return std::nullopt;
}

}  // namespace slammot::simulation
