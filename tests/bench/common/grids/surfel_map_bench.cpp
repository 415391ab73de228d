#include "common/grids/surfel_map.hpp"

#include <random>

#include <benchmark/benchmark.h>

#include "tests/support/synthetic_world.hpp"

namespace slammot::grids {
namespace {

using Eigen::Vector2d;

/// Points on the house fronts of a street, in random order, as many as asked for.
std::vector<Vector2d> points_in_a_street(int count) {
  const auto world = slammot::testing::street(120.0);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::normal_distribution<double> noise(0.0, 0.02);
  std::vector<Vector2d> points;
  for (int i = 0; i < count; ++i) {
    const auto& wall = world[random() % world.size()];
    points.push_back(wall.from_m + share(random) * (wall.to_m - wall.from_m) +
                     Vector2d(noise(random), noise(random)));
  }
  return points;
}

SurfelMap empty_map() { return {window_around({60.0, 0.0}, 240.0, 0.2), 1000.0}; }

void add_a_scan_of_361_points(benchmark::State& state) {
  SurfelMap map = empty_map();
  const auto points = points_in_a_street(361);
  for (auto _ : state) {
    for (const Vector2d& point_m : points) map.add(point_m);
  }
}
BENCHMARK(add_a_scan_of_361_points)->Unit(benchmark::kMicrosecond);

void look_up_361_points(benchmark::State& state) {
  SurfelMap map = empty_map();
  for (const Vector2d& point_m : points_in_a_street(50'000)) map.add(point_m);
  const auto points = points_in_a_street(361);
  const int radius = static_cast<int>(state.range(0));
  for (auto _ : state) {
    for (const Vector2d& point_m : points) benchmark::DoNotOptimize(map.nearest(point_m, radius));
  }
}
BENCHMARK(look_up_361_points)->Arg(1)->Arg(3)->Unit(benchmark::kMicrosecond);

void add_a_scan_and_look_it_up_again(benchmark::State& state) {
  SurfelMap map = empty_map();
  for (const Vector2d& point_m : points_in_a_street(50'000)) map.add(point_m);
  const auto points = points_in_a_street(361);
  for (auto _ : state) {
    for (const Vector2d& point_m : points) map.add(point_m);
    for (const Vector2d& point_m : points) benchmark::DoNotOptimize(map.nearest(point_m, 1));
  }
}
BENCHMARK(add_a_scan_and_look_it_up_again)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace slammot::grids
