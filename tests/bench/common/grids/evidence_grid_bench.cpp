#include "common/grids/evidence_grid.hpp"

#include <cmath>
#include <numbers>

#include <benchmark/benchmark.h>

#include "tests/support/synthetic_world.hpp"

namespace slammot::grids {
namespace {

using Eigen::Vector2d;

constexpr double kNoEchoFree_m = 40.0;

/// One scan over half a circle in a street, as rays; the beams that meet nothing within 80 m tell
/// of free space.
std::vector<Ray> rays_in_a_street(const Vector2d& origin_m, int beams) {
  const auto world = slammot::testing::street(120.0);
  std::vector<Ray> rays;
  for (int i = 0; i < beams; ++i) {
    const double angle_rad = std::numbers::pi * (static_cast<double>(i) / (beams - 1) - 0.5);
    const double range_m = slammot::testing::range_m(world, origin_m, angle_rad);
    const bool has_echo = range_m < 80.0;
    rays.push_back({origin_m + (has_echo ? range_m : kNoEchoFree_m) *
                                   Vector2d(std::cos(angle_rad), std::sin(angle_rad)),
                    has_echo ? Echo::kStationary : Echo::kNone});
  }
  return rays;
}

EvidenceGrid grid_of_a_vehicle() { return {window_around({0.0, 0.0}, 240.0, 0.2), {}}; }

double beam_step_rad(int beams) { return std::numbers::pi / (beams - 1); }

void integrate_a_scan(benchmark::State& state) {
  const int beams = static_cast<int>(state.range(0));
  const Vector2d origin_m(10.0, 0.3);
  const auto rays = rays_in_a_street(origin_m, beams);
  EvidenceGrid grid = grid_of_a_vehicle();
  for (auto _ : state) grid.integrate(origin_m, rays, beam_step_rad(beams));
  state.counters["beams/s"] =
      benchmark::Counter(beams, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(integrate_a_scan)->Arg(181)->Arg(361)->Arg(1081)->Unit(benchmark::kMicrosecond);

/// What is left of it where what the scan sees through was found beforehand.
void complete_a_prepared_scan(benchmark::State& state) {
  const int beams = static_cast<int>(state.range(0));
  const Vector2d origin_m(10.0, 0.3);
  const auto rays = rays_in_a_street(origin_m, beams);
  EvidenceGrid grid = grid_of_a_vehicle();
  for (auto _ : state) {
    state.PauseTiming();
    grid.prepare(origin_m, rays, beam_step_rad(beams));
    state.ResumeTiming();
    grid.integrate(origin_m, rays, beam_step_rad(beams));
  }
}
BENCHMARK(complete_a_prepared_scan)->Arg(361)->Unit(benchmark::kMicrosecond);

/// What it costs where neighbours do not stand in for each other near the scanner.
void integrate_a_scan_beam_by_beam(benchmark::State& state) {
  const int beams = static_cast<int>(state.range(0));
  const Vector2d origin_m(10.0, 0.3);
  const auto rays = rays_in_a_street(origin_m, beams);
  EvidenceGrid grid = grid_of_a_vehicle();
  for (auto _ : state) grid.integrate(origin_m, rays, 0.0);
  state.counters["beams/s"] =
      benchmark::Counter(beams, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(integrate_a_scan_beam_by_beam)->Arg(361)->Unit(benchmark::kMicrosecond);

void cast_a_scan(benchmark::State& state) {
  const int beams = static_cast<int>(state.range(0));
  const Vector2d origin_m(10.0, 0.3);
  EvidenceGrid grid = grid_of_a_vehicle();
  const auto rays = rays_in_a_street(origin_m, beams);
  for (int i = 0; i < 5; ++i) grid.integrate(origin_m, rays, beam_step_rad(beams));
  for (auto _ : state) {
    for (const Ray& ray : rays) {
      benchmark::DoNotOptimize(
          grid.distance_to_occupied(origin_m, (ray.end_m - origin_m).normalized(), 80.0));
    }
  }
  state.counters["beams/s"] =
      benchmark::Counter(beams, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(cast_a_scan)->Arg(181)->Arg(361)->Unit(benchmark::kMicrosecond);

void move_the_window(benchmark::State& state) {
  const EvidenceGrid grid = grid_of_a_vehicle();
  const GridWindow next = window_around({60.0, 0.0}, 240.0, 0.2);
  for (auto _ : state) benchmark::DoNotOptimize(grid.moved_to(next));
}
BENCHMARK(move_the_window)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace slammot::grids
