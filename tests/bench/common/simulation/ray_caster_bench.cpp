#include "common/simulation/ray_caster.hpp"

#include <cmath>

#include <benchmark/benchmark.h>

#include "common/simulation/city_world.hpp"
#include "common/simulation/drive.hpp"
#include "services/simulator/scenario_files.hpp"

namespace slammot::simulation {
namespace {

/// Beams of whole scans along a street of the demo city, stationary surfaces only. The yardstick is
/// 2 million beams a second on one core.
void cast_in_demo_city(benchmark::State& state) {
  const ScenarioConfig scenario = *simulator::load_scenario("block");
  const StreetPlan plan(scenario.city, scenario.seed);
  const RayCaster caster(build_city(plan, scenario.seed), static_cast<double>(state.range(0)));
  const geometry::Vector2 from = plan.junction_in_plan({1, 1});
  const geometry::Vector2 to = plan.junction_in_plan({2, 1});
  constexpr int kPlaces = 64;
  int place = 0;
  double sum_m = 0.0;
  for (auto _ : state) {
    const geometry::Vector2 origin = plan.world_from_plan(
        geometry::Vector2(from + (to - from) * (static_cast<double>(place) / kPlaces)));
    for (int beam = 0; beam < 361; ++beam) {
      const double heading_rad = -1.5707963 + 0.0087266 * beam;
      const Hit hit = caster.cast(origin, {std::cos(heading_rad), std::sin(heading_rad)}, 81.83);
      sum_m += std::isinf(hit.range_m) ? 0.0 : hit.range_m;
    }
    place = (place + 1) % kPlaces;
  }
  benchmark::DoNotOptimize(sum_m);
  state.counters["beams"] = benchmark::Counter(361.0 * static_cast<double>(state.iterations()),
                                               benchmark::Counter::kIsRate);
}
BENCHMARK(cast_in_demo_city)
    ->ArgName("cell_m")
    ->Arg(1)
    ->Arg(2)
    ->Arg(3)
    ->Arg(4)
    ->Arg(6)
    ->Unit(benchmark::kMicrosecond);

/// Whole simulated scans: three rays a beam, moving objects, noise, traffic and people.
void simulate_demo_scans(benchmark::State& state) {
  const ScenarioConfig scenario = *simulator::load_scenario("block");
  Drive drive(scenario);
  for (auto _ : state) {
    auto scan = drive.next();
    if (!scan) {
      drive = Drive(scenario);
      scan = drive.next();
    }
    benchmark::DoNotOptimize(scan);
  }
}
BENCHMARK(simulate_demo_scans)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace slammot::simulation
