#include "common/matching/correlative.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <benchmark/benchmark.h>

namespace slammot::matching {
namespace {

using geometry::Pose2;
using geometry::Vector2;

/// Walls of a block of rooms 8 m apart, one point every 0.1 m: about what an indoor scanner knows
/// around it.
std::vector<TargetPoint> rooms(double half_m) {
  std::vector<TargetPoint> points;
  std::mt19937_64 random(3);
  std::normal_distribution<float> noise(0.0F, 0.02F);
  const auto add = [&](double x, double y) {
    points.push_back(
        {static_cast<float>(x) + noise(random), static_cast<float>(y) + noise(random), 1.0F});
  };
  for (double wall = -half_m; wall <= half_m; wall += 8.0) {
    for (double along = -half_m; along <= half_m; along += 0.1) {
      const bool doorway = std::fmod(std::abs(along + 3.0 * std::sin(wall)), 8.0) < 1.2;
      if (doorway) continue;
      add(along, wall);
      add(wall, along);
    }
  }
  return points;
}

/// What a full-circle scanner at the pose sees of the target: the nearest point in every direction.
std::vector<Eigen::Vector2f> scan_from(const std::vector<TargetPoint>& target,
                                       const Pose2& target_from_source, int beams) {
  std::vector<Eigen::Vector2f> nearest(static_cast<std::size_t>(beams),
                                       Eigen::Vector2f::Constant(1e6F));
  const Pose2 source_from_target = inverse(target_from_source);
  for (const TargetPoint& point : target) {
    const Eigen::Vector2f seen = (source_from_target * Vector2(point.x_m, point.y_m)).cast<float>();
    const double turn = std::atan2(seen.y(), seen.x()) / (2.0 * std::numbers::pi) + 0.5;
    Eigen::Vector2f& kept =
        nearest[static_cast<std::size_t>(turn * beams) % static_cast<std::size_t>(beams)];
    if (seen.norm() < kept.norm()) kept = seen;
  }
  std::erase_if(nearest, [](const Eigen::Vector2f& point) { return point.norm() > 1e3F; });
  return nearest;
}

void prepare_target_for_a_scan(benchmark::State& state) {
  const auto target = rooms(20.0);
  CorrelativeMatcher matcher({});
  for (auto _ : state)
    matcher.set_target(target,
                       {.half_width_m = 20.0, .half_height_m = 20.0, .largest_shift_m = 0.5});
}
BENCHMARK(prepare_target_for_a_scan)->Unit(benchmark::kMicrosecond);

void search_with_a_scan(benchmark::State& state) {
  const auto target = rooms(20.0);
  const auto points = scan_from(target, {1.0, 2.0, 0.3}, static_cast<int>(state.range(0)));
  CorrelativeMatcher matcher({});
  matcher.set_target(target, {.half_width_m = 20.0, .half_height_m = 20.0, .largest_shift_m = 0.5});
  for (auto _ : state)
    benchmark::DoNotOptimize(matcher.search(points, {1.3, 1.8, 0.5}, {0.5, 0.5, 0.35}));
}
BENCHMARK(search_with_a_scan)->Arg(180)->Arg(360)->Unit(benchmark::kMicrosecond);

void search_for_a_loop(benchmark::State& state) {
  const auto target = rooms(20.0);
  auto points = scan_from(target, {1.0, 2.0, 0.3}, 720);
  const double half_heading_rad = static_cast<double>(state.range(0)) * std::numbers::pi / 180.0;
  CorrelativeMatcher matcher(
      {.resolution_m = 0.1, .smear_sigma_m = 0.1, .min_score = 0.5, .max_peaks = 3});
  for (auto _ : state) {
    matcher.set_target(target,
                       {.half_width_m = 20.0, .half_height_m = 20.0, .largest_shift_m = 4.0});
    benchmark::DoNotOptimize(matcher.search(points, {3.0, 0.8, 0.5}, {4.0, 4.0, half_heading_rad}));
  }
}
BENCHMARK(search_for_a_loop)->Arg(30)->Arg(180)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace slammot::matching
