#include "common/traffic/ways.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "tests/unit/common/traffic/passages.hpp"

namespace slammot::traffic {
namespace {

std::set<int> lines_of(const std::vector<Way>& ways) {
  std::set<int> lines;
  for (const Way& way : ways) lines.insert(way.line);
  return lines;
}

double length_m(const Way& way) {
  double sum_m = 0.0;
  for (std::size_t i = 1; i < way.points_in_map_m.size(); ++i)
    sum_m += (way.points_in_map_m[i] - way.points_in_map_m[i - 1]).norm();
  return sum_m;
}

double length_m(const std::vector<Way>& ways) {
  double sum_m = 0.0;
  for (const Way& way : ways) sum_m += length_m(way);
  return sum_m;
}

/// Vehicles whose centres scatter across a lane along x.
TrafficMap lane_with_scatter(int vehicles, double sigma_m) {
  std::mt19937 random(1);
  std::normal_distribution<double> offset_m(0.0, sigma_m);
  TrafficMap map;
  for (int i = 0; i < vehicles; ++i) {
    const double y_m = offset_m(random);
    map.add(straight({0.0, y_m}, {100.0, y_m}));
  }
  return map;
}

TEST(Ways, FollowTheMiddleOfALane) {
  const auto ways = find_ways(lane_with_scatter(30, 0.3));
  ASSERT_EQ(lines_of(ways).size(), 1U);
  EXPECT_NEAR(length_m(ways), 100.0, 4.0);
  for (const Way& way : ways) {
    EXPECT_LE(length_m(way), 26.0);
    EXPECT_GT(way.points_in_map_m.back().x(), way.points_in_map_m.front().x());
    for (const Vector2& point_m : way.points_in_map_m) EXPECT_NEAR(point_m.y(), 0.0, 0.15);
    EXPECT_NEAR(way.speed_mps, 10.0, 0.1);
    EXPECT_NEAR(way.width_m, 2.0 + 4.0 * 0.3, 0.4);
  }
}

TEST(Ways, CountTracksAndTrustManyMoreThanOne) {
  const Way one = find_ways(lane_with_scatter(1, 0.01)).at(1);
  const Way many = find_ways(lane_with_scatter(9, 0.1)).at(1);
  EXPECT_NEAR(one.tracks, 1.0, 0.1);
  EXPECT_NEAR(one.confidence, 0.5, 0.02);
  EXPECT_NEAR(many.tracks, 9.0, 0.5);
  EXPECT_NEAR(many.confidence, 0.9, 0.02);
}

TEST(Ways, KeepLanesOfBothDirectionsApart) {
  TrafficMap map;
  map.add(straight({0.0, 0.0}, {60.0, 0.0}));
  map.add(straight({60.0, 1.0}, {0.0, 1.0}));
  const auto ways = find_ways(map);
  EXPECT_EQ(lines_of(ways).size(), 2U);
  for (const Way& way : ways) {
    const Vector2 along_m = way.points_in_map_m.back() - way.points_in_map_m.front();
    EXPECT_NEAR(way.points_in_map_m.front().y(), along_m.x() > 0.0 ? 0.0 : 1.0, 0.05);
  }
}

TEST(Ways, KeepNeighbouringLanesApart) {
  TrafficMap map;
  for (const double y_m : {0.0, 3.0}) map.add(straight({0.0, y_m}, {60.0, y_m}));
  const auto ways = find_ways(map);
  EXPECT_EQ(lines_of(ways).size(), 2U);
  for (const Way& way : ways) {
    const double y_m = way.points_in_map_m.front().y();
    EXPECT_LT(std::min(std::abs(y_m), std::abs(y_m - 3.0)), 0.1);
  }
}

TEST(Ways, RunStraightOverACrossing) {
  TrafficMap map;
  for (int i = 0; i < 3; ++i) {
    map.add(straight({-40.0, 0.2}, {40.0, 0.2}));
    map.add(straight({0.2, -40.0}, {0.2, 40.0}));
  }
  const auto ways = find_ways(map);
  EXPECT_EQ(lines_of(ways).size(), 2U);
  EXPECT_NEAR(length_m(ways), 160.0, 6.0);
}

TEST(Ways, StayOnACurve) {
  constexpr double kRadiusM = 10.0;
  TrafficMap map;
  map.add(passage_along(
      [](double way_m) {
        return Vector2(kRadiusM * std::cos(way_m / kRadiusM),
                       kRadiusM * std::sin(way_m / kRadiusM));
      },
      kRadiusM * 1.5 * std::numbers::pi, 5.0));
  const auto ways = find_ways(map);
  EXPECT_EQ(lines_of(ways).size(), 1U);
  EXPECT_GT(length_m(ways), kRadiusM * 1.4 * std::numbers::pi);
  for (const Way& way : ways) {
    for (const Vector2& point_m : way.points_in_map_m) EXPECT_NEAR(point_m.norm(), kRadiusM, 0.2);
  }
}

TEST(Ways, CloseARoundabout) {
  constexpr double kRadiusM = 12.0;
  TrafficMap map;
  map.add(passage_along(
      [](double way_m) {
        return Vector2(kRadiusM * std::cos(way_m / kRadiusM),
                       kRadiusM * std::sin(way_m / kRadiusM));
      },
      kRadiusM * 8.0 * std::numbers::pi, 5.0));
  const auto ways = find_ways(map);
  EXPECT_NEAR(length_m(ways), kRadiusM * 2.0 * std::numbers::pi, 4.0);
  EXPECT_NEAR(ways.front().tracks, 4.0, 0.3);
}

TEST(Ways, LeaveTheLaneWhereATurnDoes) {
  const auto turning = [](double way_m) {
    constexpr double kRadiusM = 8.0;
    const double arc_rad = std::clamp((way_m - 40.0) / kRadiusM, 0.0, 0.5 * std::numbers::pi);
    const double beyond_m = std::max(0.0, way_m - 40.0 - 0.5 * std::numbers::pi * kRadiusM);
    return Vector2(std::min(way_m, 40.0) + kRadiusM * std::sin(arc_rad),
                   kRadiusM * (1.0 - std::cos(arc_rad)) + beyond_m);
  };
  TrafficMap map;
  for (int i = 0; i < 4; ++i) map.add(straight({0.0, 0.0}, {80.0, 0.0}));
  map.add(passage_along(turning, 80.0, 8.0));
  const auto ways = find_ways(map);
  EXPECT_EQ(lines_of(ways).size(), 2U);
  EXPECT_NEAR(length_m(ways), 80.0 + 40.0, 8.0);
}

TEST(Ways, OfPedestriansAreUsedBothWays) {
  TrafficMap map;
  for (const auto& [from_x_m, to_x_m] : {std::pair(0.0, 40.0), {40.0, 0.0}}) {
    Passage passage = straight({from_x_m, 0.2}, {to_x_m, 0.2}, 1.4);
    passage.mover = Mover::kPedestrian;
    map.add(passage);
  }
  const auto ways = find_ways(map);
  EXPECT_EQ(lines_of(ways).size(), 1U);
  EXPECT_EQ(ways.front().mover, Mover::kPedestrian);
  EXPECT_NEAR(ways.front().tracks, 2.0, 0.2);
  EXPECT_GT(ways.front().confidence, 0.6);
}

TEST(Ways, MoveWithTheWorld) {
  const geometry::Pose2 moved_from_world{137.0, -52.0, 0.7};
  TrafficMap map;
  TrafficMap moved;
  const Vector2 from_m{0.0, 0.1};
  const Vector2 to_m{70.0, 0.1};
  map.add(straight(from_m, to_m));
  moved.add(straight(moved_from_world * from_m, moved_from_world * to_m));
  const auto ways = find_ways(moved);
  EXPECT_NEAR(length_m(ways), length_m(find_ways(map)), 2.0);
  for (const Way& way : ways) {
    for (const Vector2& point_m : way.points_in_map_m)
      EXPECT_NEAR((geometry::inverse(moved_from_world) * point_m).y(), 0.1, 0.1);
  }
}

TEST(Ways, OfAnEmptyMapAreNone) { EXPECT_TRUE(find_ways(TrafficMap()).empty()); }

}  // namespace
}  // namespace slammot::traffic
