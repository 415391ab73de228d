#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "common/grids/surfel_map.hpp"
#include "common/matching/point_to_line.hpp"
#include "tests/support/synthetic_world.hpp"

namespace slammot::testing {

/// Surfels of walls that were seen every 2 cm, exactly.
inline grids::SurfelMap surfels_of(const World& world,
                                   const geometry::Vector2& centre_m = geometry::Vector2::Zero(),
                                   double cell_m = 0.2) {
  grids::SurfelMap surfels(grids::window_around(centre_m, 60.0, cell_m), 1000.0);
  for (const Wall& wall : world) {
    const geometry::Vector2 along_m = wall.to_m - wall.from_m;
    const int points = static_cast<int>(along_m.norm() / 0.02);
    for (int i = 0; i <= points; ++i) surfels.add(wall.from_m + along_m * i / points);
  }
  return surfels;
}

/// A full turn of beams from a pose in the world, as points in base, with noise along the beams.
inline std::vector<matching::MatchPoint> points_seen(const World& world,
                                                     const geometry::Pose2& world_from_base,
                                                     int beams, double noise_m,
                                                     std::mt19937& random,
                                                     double max_range_m = 80.0) {
  std::normal_distribution<double> noise(0.0, 1.0);
  std::vector<matching::MatchPoint> points;
  for (int i = 0; i < beams; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / beams;
    const double exact_m =
        range_m(world, world_from_base.translation_m(), world_from_base.heading_rad + angle_rad);
    if (exact_m > max_range_m) continue;
    const double measured_m = exact_m + noise_m * noise(random);
    points.push_back({{measured_m * std::cos(angle_rad), measured_m * std::sin(angle_rad)},
                      std::max(noise_m, 0.01)});
  }
  return points;
}

}  // namespace slammot::testing
