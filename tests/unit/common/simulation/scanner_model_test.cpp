#include "common/simulation/scanner_model.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace slammot::simulation {
namespace {

using geometry::Pose2;

constexpr double kStep_s = 1.0 / 37.5;
constexpr std::size_t kStraightAhead = 180;

ScannerConfig exact_scanner() {
  ScannerConfig config;
  config.ahead_m = 0.0;
  config.noise_floor_m = config.noise_per_m = 0.0;
  config.resolution_m = 1e-6;
  config.mixed_share = config.drop_out = config.dark_drop_out = 0.0;
  return config;
}

Outline wall_ahead(double x_m) {
  Outline outline;
  outline.segments.push_back({{x_m, -100.0}, {x_m, 100.0}, Material::wall});
  return outline;
}

MovingObject car_at(const Pose2& world_from_object) {
  MovingObject car;
  car.size = {4.5, 1.8};
  car.world_from_object = world_from_object;
  car.outline_in_object = vehicle_outline(ObjectClass::car, car.size);
  return car;
}

ScannedWorld scan(const ScannerConfig& config, const Outline& outline, const Moment& before,
                  const Moment& after) {
  Random random(1, Purpose::scanner);
  return scan_world(config, RayCaster(outline), {before, after, kStep_s}, random);
}

TEST(ScanWorld, MeasuresAWallWhereItIs) {
  const Moment still;
  const ScannedWorld scanned = scan(exact_scanner(), wall_ahead(20.0), still, still);
  EXPECT_NEAR(scanned.range_m[kStraightAhead], 20.0, 1e-5);
  EXPECT_NEAR(scanned.range_m[kStraightAhead + 120], 40.0, 1e-4);  // 60 degrees to the left
  EXPECT_EQ(scanned.source[kStraightAhead], kStationary);
}

TEST(ScanWorld, ReadsMaximumRangeWhereThereIsNoEcho) {
  const Moment still;
  const ScannedWorld scanned = scan(exact_scanner(), wall_ahead(100.0), still, still);
  EXPECT_FLOAT_EQ(scanned.range_m[kStraightAhead], 81.83F);
  EXPECT_EQ(scanned.source[kStraightAhead], kNothing);
}

TEST(ScanWorld, FiresEachBeamFromWhereTheVehicleIsThen) {
  Moment before;
  Moment after;
  after.world_from_base = {0.4, 0.0, 0.0};  // 15 m/s
  const ScannedWorld scanned = scan(exact_scanner(), wall_ahead(20.0), before, after);
  // The middle beam fires after half the sweep of 1/75 s, the last after all of it.
  EXPECT_NEAR(scanned.range_m[kStraightAhead], 20.0 - 15.0 / 150.0, 1e-4);
  EXPECT_NEAR(scanned.range_m[kStraightAhead + 120] * 0.5, 20.0 - 15.0 / 75.0 * 300.0 / 360.0,
              1e-4);
}

TEST(ScanWorld, FindsAMovingObjectWhereItIsWhenTheBeamFires) {
  Moment before;
  Moment after;
  before.objects = {car_at({20.0, 0.0, 0.0})};
  after.objects = {car_at({20.4, 0.0, 0.0})};
  const ScannedWorld scanned = scan(exact_scanner(), wall_ahead(60.0), before, after);
  EXPECT_NEAR(scanned.range_m[kStraightAhead], 20.0 - 2.25 + 0.1, 1e-4);
  EXPECT_EQ(scanned.source[kStraightAhead], 0);
}

TEST(ScanWorld, SeesNothingThroughAMovingObjectAndNothingInItsPlaceBehindAWall) {
  Moment still;
  still.objects = {car_at({20.0, 0.0, 0.3}), car_at({30.0, 0.0, 0.0})};
  const ScannedWorld before_wall = scan(exact_scanner(), wall_ahead(60.0), still, still);
  EXPECT_EQ(std::count(before_wall.source.begin(), before_wall.source.end(), 1), 0);
  const ScannedWorld behind_wall = scan(exact_scanner(), wall_ahead(10.0), still, still);
  EXPECT_EQ(std::count(behind_wall.source.begin(), behind_wall.source.end(), 0), 0);
}

TEST(ScanWorld, HitsTheRoadWhenTheNoseIsDown) {
  Moment braking;
  braking.nose_down_rad = 0.02;
  const ScannedWorld scanned = scan(exact_scanner(), wall_ahead(60.0), braking, braking);
  EXPECT_NEAR(scanned.range_m[kStraightAhead + 1], 0.6 / 0.02, 0.1);
}

TEST(ScanWorld, LooksFromWhereTheScannerIsMounted) {
  ScannerConfig config = exact_scanner();
  config.ahead_m = 1.0;
  config.left_m = 2.0;
  config.heading_rad = M_PI_2;
  Moment still;
  still.world_from_base = {0.0, 0.0, -M_PI_2};  // so that it looks along x, from (2, -1)
  const ScannedWorld scanned = scan(config, wall_ahead(20.0), still, still);
  EXPECT_NEAR(scanned.range_m[kStraightAhead], 18.0, 1e-4);
  EXPECT_TRUE((scanner_of(config).base_from_laser == Pose2{1.0, 2.0, M_PI_2}));
}

TEST(ScanWorld, MeasuresAlongTheBeamOfATippedScanner) {
  ScannerConfig config = exact_scanner();
  config.nose_down_rad = -0.3;
  const Moment still;
  const ScannedWorld scanned = scan(config, wall_ahead(20.0), still, still);
  EXPECT_NEAR(scanned.range_m[kStraightAhead], 20.0 / std::cos(0.3), 1e-4);
  config.nose_down_rad = 0.0;
  config.left_up_rad = 0.05;  // the right side looks down: 0.6 m under it after 0.6 / sin(0.05)
  const ScannedWorld rolled = scan(config, {}, still, still);
  EXPECT_NEAR(rolled.range_m[0], 0.6 / std::sin(0.05), 1e-3);
  EXPECT_EQ(rolled.source[360], kNothing);
}

TEST(ScanWorld, SeesOverWhatIsLowAndNotOverWhatIsHigh) {
  ScannerConfig config = exact_scanner();
  config.nose_down_rad = -0.1;
  Outline outline = wall_ahead(60.0);
  outline.circles.push_back({{30.0, 0.0}, 0.5, Material::foliage});  // the beam is 3.5 m up there
  Moment still;
  still.objects = {car_at({20.0, 0.0, 0.0})};
  const ScannedWorld over = scan(config, outline, still, still);
  EXPECT_NEAR(over.range_m[kStraightAhead], 60.0 / std::cos(0.1), 1e-4);
  config.nose_down_rad = -0.01;
  EXPECT_EQ(scan(config, outline, still, still).source[kStraightAhead], 0);
}

TEST(ScanWorld, ScansAVerticalProfileWhenTurnedOnItsSide) {
  ScannerConfig config = exact_scanner();
  config.left_up_rad = M_PI_2;
  config.height_m = 2.0;
  const Moment still;
  const ScannedWorld scanned = scan(config, wall_ahead(8.0), still, still);
  EXPECT_NEAR(scanned.range_m[kStraightAhead], 8.0, 1e-4);
  EXPECT_NEAR(scanned.range_m[kStraightAhead + 80], 8.0 / std::cos(80.0 / 360.0 * M_PI),
              1e-3);                                          // 40 degrees up the wall
  EXPECT_EQ(scanned.source[kStraightAhead + 120], kNothing);  // 60 degrees: over its 12 m
  EXPECT_NEAR(scanned.range_m[0], 2.0, 1e-3);                 // straight down
  // the road at 60 degrees
  EXPECT_NEAR(scanned.range_m[kStraightAhead - 120], 2.0 / std::sin(M_PI / 3.0), 1e-3);
}

TEST(ScanWorld, MeetsARisingRoad) {
  const Terrain ramp({{20.0, 0.0}, {40.0, 2.0}});
  const Moment still;
  Random random(1, Purpose::scanner);
  const ScannedWorld scanned = scan_world(exact_scanner(), RayCaster(wall_ahead(60.0)),
                                          {still, still, kStep_s, ramp}, random);
  const auto from_road =
      std::count_if(scanned.range_m.begin() + 170, scanned.range_m.begin() + 190,
                    [](float range_m) { return std::abs(range_m - 26.0F) < 0.2F; });
  EXPECT_GT(from_road, 10);  // some 30 % give no echo from so flat a surface
}

TEST(ScanWorld, PutsMixedPixelsBetweenTheTwoSurfacesOfASplitSpot) {
  ScannerConfig config = exact_scanner();
  config.mixed_share = 1.0;
  Moment still;
  still.objects = {car_at({20.0, 0.0, 0.0})};
  const ScannedWorld scanned = scan(config, wall_ahead(40.0), still, still);
  const auto between =
      std::count_if(scanned.range_m.begin(), scanned.range_m.end(),
                    [](float range_m) { return range_m > 18.5F && range_m < 39.9F; });
  EXPECT_GE(between, 1);
  EXPECT_LE(between, 4);
}

TEST(ScanWorld, SpreadsReadingsAsTheNoiseModelSays) {
  ScannerConfig config = exact_scanner();
  config.noise_floor_m = 0.012;
  config.noise_per_m = 0.0013;
  const Moment still;
  const RayCaster wall(wall_ahead(20.0));
  Random random(2, Purpose::scanner);
  constexpr int kScans = 3000;
  double squares = 0.0;
  for (int i = 0; i < kScans; ++i) {
    const double error_m =
        scan_world(config, wall, {still, still, kStep_s}, random).range_m[kStraightAhead] - 20.0;
    squares += error_m * error_m;
  }
  const double sigma_m = 0.012 + 0.0013 * 20.0;
  EXPECT_NEAR(squares / kScans / (sigma_m * sigma_m), 1.0, 4.0 * std::sqrt(2.0 / kScans));
}

TEST(ScannerOf, DescribesTheBeamsAsTheyAreFired) {
  const sensing::Scanner scanner = scanner_of(ScannerConfig{});
  EXPECT_DOUBLE_EQ(scanner.base_from_laser.x_m, 2.15);
  EXPECT_NEAR(scanner.beam_step_rad * 360.0, 3.141593, 1e-12);
  EXPECT_DOUBLE_EQ(scanner.sweep_s, 1.0 / 75.0);
}

TEST(RangeSigma, IsOfTheDataSheetOrOnePerCentIfWanted) {
  ScannerConfig config;
  EXPECT_DOUBLE_EQ(range_sigma_m(config, 10.0), 0.025);
  config.noise = RangeNoise::data_sheet;
  EXPECT_DOUBLE_EQ(range_sigma_m(config, 10.0), 0.01);
  EXPECT_DOUBLE_EQ(range_sigma_m(config, 80.0), 0.01);
  config.noise = RangeNoise::conservative;
  EXPECT_DOUBLE_EQ(range_sigma_m(config, 10.0), 0.1);
}

TEST(ScanWorld, FindsTheWorldWhereItIsWhenASweepBeginsLater) {
  const Moment before;
  Moment after;
  after.world_from_base = {2.0, 0.0, 0.0};  // towards the wall
  Random random(1, Purpose::scanner);
  ScannerConfig config = exact_scanner();
  config.sweep_s = 0.0;
  const ScannedWorld scanned =
      scan_world(config, RayCaster(wall_ahead(20.0)),
                 {before, after, kStep_s, kLevelRoad, 0.25 * kStep_s}, random);
  EXPECT_NEAR(scanned.range_m[kStraightAhead], 19.5, 1e-4);
}

}  // namespace
}  // namespace slammot::simulation
