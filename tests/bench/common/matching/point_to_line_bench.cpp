#include "common/matching/point_to_line.hpp"

#include <cmath>
#include <numbers>

#include <benchmark/benchmark.h>

#include "tests/support/synthetic_world.hpp"

namespace slammot::matching {
namespace {

using geometry::Pose2;
using geometry::Vector2;

grids::SurfelMap surfels_of_a_street(const slammot::testing::World& world) {
  grids::SurfelMap surfels(grids::window_around({60.0, 0.0}, 240.0, 0.2), 1000.0);
  for (const auto& wall : world) {
    const Vector2 along_m = wall.to_m - wall.from_m;
    const int points = static_cast<int>(along_m.norm() / 0.02);
    for (int i = 0; i <= points; ++i) surfels.add(wall.from_m + along_m * i / points);
  }
  return surfels;
}

/// A whole match from 10 cm and 0.6 degrees off.
void match_a_scan(benchmark::State& state) {
  const auto world = slammot::testing::street(120.0);
  const auto surfels = surfels_of_a_street(world);
  const Pose2 truth{30.0, 0.3, 0.02};
  const int beams = static_cast<int>(state.range(0));
  std::vector<MatchPoint> points;
  for (int i = 0; i < beams; ++i) {
    const double angle_rad = std::numbers::pi * (static_cast<double>(i) / (beams - 1) - 0.5);
    const double range_m = slammot::testing::range_m(world, truth.translation_m(), truth.heading_rad + angle_rad);
    if (range_m < 80.0) points.push_back({{range_m * std::cos(angle_rad), range_m * std::sin(angle_rad)}, 0.03});
  }
  const Pose2 prior = truth * Pose2{0.1, 0.0, 0.01};
  const geometry::UncertainPose2 uncertain_prior{prior, Eigen::Vector3d(0.01, 0.01, 0.0001).asDiagonal()};
  PointToLineMatcher matcher;
  for (auto _ : state) benchmark::DoNotOptimize(matcher.match(points, surfels, uncertain_prior, prior, {}));
}
BENCHMARK(match_a_scan)->Arg(181)->Arg(361)->Arg(1081)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace slammot::matching
