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

/// A small robot with the scanner and odometry of the indoor logs that everybody knows.
ScenarioConfig indoor() {
  ScenarioConfig scenario;
  scenario.place = Place::office;
  scenario.start_stamp_s = 1.0;
  scenario.log_record = LogRecord::flaser;
  scenario.profile = "indoor";
  scenario.scanner.ahead_m = 0.0;
  scenario.scanner.height_m = 0.35;
  scenario.scanner.beams = 180;
  scenario.scanner.field_of_view_rad = 3.124139;  // 179 steps of one degree
  scenario.scanner.rate_hz = 5.0;
  scenario.scanner.noise_floor_m = 0.01;
  scenario.scanner.noise_per_m = 0.001;
  scenario.scanner.spot_rad = 0.0115;
  scenario.suspension.pitch_per_mps2_rad = 0.0;
  scenario.odometry.scale_error_low = 0.01;
  scenario.odometry.scale_error_high = 0.03;
  scenario.odometry.distance_noise = 0.03;
  scenario.odometry.heading_noise_rad = 0.003;
  scenario.odometry.rate_bias_sigma_radps = 0.0015;
  scenario.odometry.rate_bias_walk_radps = 0.0003;
  scenario.walkers.speed_mps = 1.1;
  scenario.walkers.runner_share = 0.0;
  scenario.walkers.trio_share = 0.0;
  scenario.walkers.pair_share = 0.15;
  scenario.walkers.sideways_m = 0.35;
  return scenario;
}

ScenarioConfig office() {
  ScenarioConfig scenario = indoor();
  scenario.description = "a slow robot twice around the corridors of an office, people walking";
  scenario.duration_s = 480.0;
  scenario.walkers.pedestrians = 9;
  scenario.robot_way = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}, {2, 0}, {2, 1}, {0, 1}, {0, 0}, {1, 0}};
  return scenario;
}

ScenarioConfig corridor() {
  ScenarioConfig scenario = indoor();
  scenario.description = "a slow robot along corridors without coming back, people walking";
  scenario.duration_s = 170.0;
  scenario.office.length_m = 60.0;
  scenario.walkers.pedestrians = 8;
  scenario.robot_way = {{0, 1}, {0, 0}, {2, 0}};
  return scenario;
}

struct Shipped {
  std::string_view name;
  ScenarioConfig (*make)();
};
constexpr Shipped kShipped[] = {{"demo", demo}, {"city", city}, {"quiet", quiet}, {"office", office}, {"corridor", corridor}};

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
