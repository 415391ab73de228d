#include "common/sensing/deskew.hpp"

#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/synthetic_world.hpp"

namespace slammot::sensing {
namespace {

using geometry::Pose2;
using geometry::Vector2;
using slammot::testing::Path;
using slammot::testing::World;

std::vector<Vector2> deskewed(const LaserScan& scan, double speed_mps, double yaw_rate_radps) {
  std::vector<Vector2> points_in_base_m;
  deskew(scan, speed_mps, yaw_rate_radps, points_in_base_m);
  return points_in_base_m;
}

Scanner sweeping_scanner() {
  Scanner scanner = slammot::testing::half_circle_scanner();
  scanner.sweep_s = 1.0 / 75.0;
  scanner.base_from_laser = {2.15, -0.3, 0.2};
  return scanner;
}

/// Distance from a point to the nearest wall.
double off_the_walls_m(const World& world, const Vector2& point_m) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const auto& wall : world) {
    const Vector2 along_m = wall.to_m - wall.from_m;
    const double share =
        std::clamp((point_m - wall.from_m).dot(along_m) / along_m.squaredNorm(), 0.0, 1.0);
    nearest_m = std::min(nearest_m, (wall.from_m + share * along_m - point_m).norm());
  }
  return nearest_m;
}

double worst_point_m(const World& world, const Pose2& world_from_base,
                     const std::vector<Vector2>& points_in_base_m) {
  double worst_m = 0.0;
  for (const Vector2& point_m : points_in_base_m)
    worst_m = std::max(worst_m, off_the_walls_m(world, world_from_base * point_m));
  return worst_m;
}

struct Motion {
  double speed_mps;
  double yaw_rate_radps;
};

class DeskewOfAMovingScanner : public ::testing::TestWithParam<Motion> {};

TEST_P(DeskewOfAMovingScanner, PutsEveryPointBackOntoItsWall) {
  const auto [speed_mps, yaw_rate_radps] = GetParam();
  const World world = slammot::testing::room();
  const Path path = slammot::testing::arc({-3.0, 0.5, 0.7}, speed_mps, yaw_rate_radps);
  std::mt19937 random(1);
  const LaserScan scan = scan_along(world, path, 0.0, sweeping_scanner(), 181, 0.0, random);
  EXPECT_LT(worst_point_m(world, path(0.0), deskewed(scan, speed_mps, yaw_rate_radps)), 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Motions, DeskewOfAMovingScanner,
                         ::testing::Values(Motion{0.0, 0.0}, Motion{15.0, 0.0}, Motion{-3.0, 0.0},
                                           Motion{0.0, 1.5}, Motion{10.0, -0.6},
                                           Motion{10.0, 0.6}));

TEST(Deskew, MattersAtTheSpeedOfACar) {
  const World world = slammot::testing::room();
  const Path path = slammot::testing::arc({-3.0, 0.5, 0.7}, 15.0, 0.5);
  std::mt19937 random(1);
  const LaserScan scan = scan_along(world, path, 0.0, sweeping_scanner(), 181, 0.0, random);
  EXPECT_GT(worst_point_m(world, path(0.0), deskewed(scan, 0.0, 0.0)), 0.1);
}

TEST(Deskew, WithoutSweepTimeIsThePolarScanInTheBaseFrame) {
  LaserScan scan;
  scan.scanner = slammot::testing::half_circle_scanner();
  scan.scanner.base_from_laser = {1.0, 2.0, std::numbers::pi / 2.0};
  scan.range_m.assign(181, 10.0F);
  const auto points_m = deskewed(scan, 20.0, 1.0);
  EXPECT_NEAR((points_m[90] - Vector2(1.0, 12.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((points_m[0] - Vector2(11.0, 2.0)).norm(), 0.0, 1e-12);
}

TEST(Deskew, GivesTheLasersPlaceForBeamsWithoutEcho) {
  LaserScan scan;
  scan.scanner = sweeping_scanner();
  scan.range_m = {std::numeric_limits<float>::quiet_NaN(), 0.0F, -1.0F, 50.0F,
                  std::numeric_limits<float>::infinity()};
  const auto points_m = deskewed(scan, 20.0, 1.0);
  ASSERT_EQ(points_m.size(), scan.range_m.size());
  for (const Vector2& point_m : points_m) EXPECT_EQ(point_m, Vector2(2.15, -0.3));
}

TEST(Deskew, OfAScanWithoutBeamsIsEmpty) { EXPECT_TRUE(deskewed(LaserScan{}, 1.0, 1.0).empty()); }

TEST(Deskew, ReplacesWhatTheBufferHeld) {
  std::vector<Vector2> points_m(500, Vector2(9.0, 9.0));
  deskew(LaserScan{.range_m = {1.0F, 2.0F}}, 0.0, 0.0, points_m);
  EXPECT_EQ(points_m.size(), 2U);
}

}  // namespace
}  // namespace slammot::sensing
