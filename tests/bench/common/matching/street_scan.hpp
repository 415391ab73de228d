#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "common/matching/point_to_line.hpp"
#include "tests/support/synthetic_world.hpp"

namespace slammot::matching {

/// Half a turn of beams in a street whose surfels are known, and a prediction that is 10 cm and 0.6
/// degrees off.
struct StreetScan {
  grids::SurfelMap surfels;
  std::vector<MatchPoint> points;
  geometry::Pose2 truth{30.0, 0.3, 0.02};
  geometry::UncertainPose2 prior;
};

inline grids::SurfelMap surfels_of_a_street(const testing::World& world) {
  grids::SurfelMap surfels(grids::window_around({60.0, 0.0}, 240.0, 0.2), 1000.0);
  for (const auto& wall : world) {
    const geometry::Vector2 along_m = wall.to_m - wall.from_m;
    const int points = static_cast<int>(along_m.norm() / 0.02);
    for (int i = 0; i <= points; ++i) surfels.add(wall.from_m + along_m * i / points);
  }
  return surfels;
}

inline StreetScan scan_in_a_street(int beams, double noise_m = 0.02) {
  const auto world = testing::street(120.0);
  StreetScan scan{.surfels = surfels_of_a_street(world), .points = {}, .prior = {}};
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < beams; ++i) {
    const double angle_rad = std::numbers::pi * (static_cast<double>(i) / (beams - 1) - 0.5);
    const double exact_m =
        testing::range_m(world, scan.truth.translation_m(), scan.truth.heading_rad + angle_rad);
    const double range_m = exact_m + noise_m * normal(random);
    if (exact_m < 80.0)
      scan.points.push_back({{range_m * std::cos(angle_rad), range_m * std::sin(angle_rad)}, 0.03});
  }
  scan.prior = {scan.truth * geometry::Pose2{0.1, 0.0, 0.01},
                Eigen::Vector3d(0.01, 0.01, 0.0001).asDiagonal()};
  return scan;
}

inline double error_mm(const geometry::Pose2& found, const geometry::Pose2& truth) {
  return 1000.0 * (found.translation_m() - truth.translation_m()).norm();
}

}  // namespace slammot::matching
