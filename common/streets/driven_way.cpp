#include "common/streets/driven_way.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::streets {
namespace {

using geometry::Pose2;

constexpr double kTurn_per_m = 0.025;  // curvature, radius 40 m

double distance_m(const Pose2& a, const Pose2& b) {
  return (a.translation_m() - b.translation_m()).norm();
}

std::vector<int> stretches_of(const std::vector<Pose2>& points) {
  std::vector<bool> is_turn(points.size(), false);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double turn_rad = geometry::wrap_angle(points[i].heading_rad - points[i - 1].heading_rad);
    if (std::abs(turn_rad) > kTurn_per_m * distance_m(points[i], points[i - 1]))
      is_turn[i - 1] = is_turn[i] = true;
  }
  std::vector<int> stretches(points.size(), DrivenWay::kTurn);
  int number = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (is_turn[i]) continue;
    if (i > 0 && is_turn[i - 1]) ++number;
    stretches[i] = number;
  }
  return stretches;
}

}  // namespace

double DrivenWay::length_m() const {
  double sum_m = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) sum_m += distance_m(points[i], points[i - 1]);
  return sum_m;
}

double DrivenWay::reach_m() const {
  double most_m = 0.0;
  for (const Pose2& point : points) most_m = std::max(most_m, distance_m(point, points.front()));
  return most_m;
}

DrivenWay driven_way(std::span<const Pose2> poses) {
  DrivenWay way;
  for (const Pose2& pose : poses) {
    if (way.points.empty() || distance_m(pose, way.points.back()) >= DrivenWay::kSpacing_m)
      way.points.push_back(pose);
  }
  way.stretches = stretches_of(way.points);
  return way;
}

}  // namespace slammot::streets
