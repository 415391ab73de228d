#include "common/city_model/profile_model.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace slammot::city_model {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSpeed_mps = 10.0;
constexpr double kSide_m = 8.2;  ///< Of the walls on both sides,
constexpr double kWall_m = 6.0;  ///< and their height.
constexpr double kScanner_m = 2.0;

const sensing::SpatialMounting kNoseUp =
    sensing::in_space({1.0, 0.0, 0.0}, {kScanner_m, 0.0, -0.5 * kPi});

/// Straight along x for 2 s, a pose each 0.05 s; published live with this error along y.
EstimatedDrive straight_drive(double online_y_m = 0.0) {
  EstimatedDrive drive;
  for (int i = 0; i <= 45; ++i) {
    const std::int64_t stamp_ns = std::int64_t{50'000'000} * i;
    const double x_m = kSpeed_mps * 0.05 * i;
    drive.corrected.push_back({stamp_ns, {x_m, 0.0, 0.0}});
    drive.online.push_back({stamp_ns, {x_m, online_y_m, 0.0}});
  }
  return drive;
}

/// What a scanner over a road between two walls reads; left of it a box of this height, 3 m away.
sensing::LaserScan street_scan(double time_s, double box_m = 0.0) {
  sensing::LaserScan scan;
  scan.stamp_ns = static_cast<std::int64_t>(time_s * 1e9);
  scan.scanner = {"roof", {}, -0.75 * kPi, 1.5 * kPi / 270, 80.0, 0.0};
  for (std::size_t beam = 0; beam <= 270; ++beam) {
    const double from_zenith_rad = sensing::beam_angle_rad(scan.scanner, beam);  // to the left
    const double side = std::sin(from_zenith_rad);
    const double up = std::cos(from_zenith_rad);
    double range_m = 80.0;
    if (up < 0.0) range_m = std::min(range_m, -kScanner_m / up);
    const auto meets = [&](double side_m, double top_m, double sign) {
      if (sign * side <= 0.0) return;
      const double reach_m = side_m / std::abs(side);
      const double z_m = kScanner_m + up * reach_m;
      if (z_m >= 0.0 && z_m <= top_m) range_m = std::min(range_m, reach_m);
    };
    meets(kSide_m, kWall_m, 1.0);
    meets(kSide_m, kWall_m, -1.0);
    if (box_m > 0.0) meets(3.0, box_m, 1.0);
    scan.range_m.push_back(static_cast<float>(range_m));
  }
  return scan;
}

CityModel model_of(const EstimatedDrive& drive, double box_m = 0.0) {
  ProfileModel model(drive, {});
  for (int i = 0; i < 50; ++i) model.add(street_scan(0.04 * i, box_m), kNoseUp);
  return model.finish();
}

bool is_on_a_wall(const PlacedEcho& point) {
  return std::abs(std::abs(point.position_in_map_m.y()) - static_cast<float>(kSide_m)) < 0.01F;
}

TEST(ProfileModel, HasTheWallsAndLeavesOutTheRoad) {
  const EstimatedDrive drive = straight_drive();
  const CityModel model = model_of(drive);
  ASSERT_GT(model.points.size(), 1000U);
  EXPECT_TRUE(std::ranges::all_of(model.points, is_on_a_wall));
  EXPECT_GT(model.counts.of_road, 1000U);
  for (const Facade& facade : model.facades) {
    EXPECT_NEAR(facade.top_m, kWall_m, 0.3);
    EXPECT_EQ(facade.bottom_m, 0.0);
    EXPECT_GE(facade.from_m.x(), 0.0);
    EXPECT_LE(facade.to_m.x(), 23.0);
  }
}

TEST(ProfileModel, IsPlacedByTheCorrectedTrajectory) {
  const EstimatedDrive drive = straight_drive(/*online_y_m=*/3.0);
  EXPECT_TRUE(std::ranges::all_of(model_of(drive).points, is_on_a_wall));
}

TEST(ProfileModel, LeavesOutTrackedObjectsInTheFrameInWhichTheyWerePublished) {
  EstimatedDrive drive = straight_drive(/*online_y_m=*/3.0);
  EXPECT_FALSE(std::ranges::all_of(model_of(drive, 1.5).points, is_on_a_wall));
  for (const metrics::StampedPose& pose : drive.online)
    drive.movers.add(1, {pose.stamp_ns,
                         {pose.pose.x_m + 1.0, pose.pose.y_m + 3.9, 0.0},
                         {kSpeed_mps, 0.0},
                         4.4,
                         1.8});
  const CityModel model = model_of(drive, 1.5);
  EXPECT_TRUE(std::ranges::all_of(model.points, is_on_a_wall));
  EXPECT_GT(model.counts.of_movers, 100U);
}

TEST(ProfileModel, LeavesOutWhatStoodWhereTheMapIsFree) {
  EstimatedDrive drive = straight_drive();
  drive.stationary = {300,   100,
                      0.2,   -20.0,
                      -10.0, std::vector<metrics::CellState>(30'000, metrics::CellState::kUnknown)};
  for (std::size_t row = 35; row < 75; ++row) {
    for (std::size_t column = 0; column < 300; ++column)
      drive.stationary.state[row * 300 + column] = metrics::CellState::kFree;
  }
  const CityModel model = model_of(drive, 1.5);
  EXPECT_TRUE(std::ranges::all_of(model.points, is_on_a_wall));
  EXPECT_GT(model.counts.in_free_space, 100U);
}

TEST(ProfileModel, SkipsScansWithoutAPose) {
  const EstimatedDrive drive = straight_drive();
  ProfileModel model(drive, {});
  model.add(street_scan(100.0), kNoseUp);
  const CityModel built = model.finish();
  EXPECT_EQ(built.counts.scans_without_pose, 1U);
  EXPECT_TRUE(built.points.empty());
}

TEST(ProfileModel, PlacesEachBeamByTheTimeOfItsFiring) {
  const EstimatedDrive drive = straight_drive();
  ProfileModel model(drive, {});
  sensing::LaserScan scan = street_scan(1.0);
  scan.scanner.sweep_s = 0.1;
  model.add(scan, kNoseUp);
  const CityModel built = model.finish();
  ASSERT_FALSE(built.points.empty());
  for (const PlacedEcho& point : built.points)
    EXPECT_NEAR(point.position_in_map_m.x(), 11.0 + 1.0 * point.beam / 270.0, 1e-3);
}

}  // namespace
}  // namespace slammot::city_model
