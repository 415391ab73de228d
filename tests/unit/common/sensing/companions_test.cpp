#include "common/sensing/companions.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slammot::sensing {
namespace {

using geometry::Pose2;
using geometry::Vector2;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::size_t kBeams = 181;
constexpr double kStepRad = std::numbers::pi / 180.0;
constexpr float kWall_m = 6.0F;
constexpr double kRadius_m = 0.25;

/// What a scanner sees of round things of 0.25 m radius before a wall all round.
std::vector<float> readings(const std::vector<Vector2>& things_m) {
  std::vector<float> range_m(kBeams, kWall_m);
  for (std::size_t beam = 0; beam < kBeams; ++beam) {
    const double angle_rad = -std::numbers::pi / 2 + kStepRad * static_cast<double>(beam);
    for (const Vector2& thing_m : things_m) {
      const double along_m = thing_m.x() * std::cos(angle_rad) + thing_m.y() * std::sin(angle_rad);
      const double aside_m = thing_m.y() * std::cos(angle_rad) - thing_m.x() * std::sin(angle_rad);
      if (along_m <= 0.0 || std::abs(aside_m) > kRadius_m) continue;
      const double met_m = along_m - std::sqrt(kRadius_m * kRadius_m - aside_m * aside_m);
      range_m[beam] = std::min(range_m[beam], static_cast<float>(met_m));
    }
  }
  return range_m;
}

BeamReadings scan_of(const std::vector<float>& range_m) {
  return {range_m, -std::numbers::pi / 2, kStepRad, 80.0};
}

std::vector<std::size_t> beams_of(const std::vector<float>& range_m) {
  std::vector<std::size_t> beams;
  for (std::size_t beam = 0; beam < kBeams; ++beam)
    if (range_m[beam] < kWall_m) beams.push_back(beam);
  return beams;
}

class CompanionsOfADrive : public ::testing::TestWithParam<double> {};  // metres a scan

TEST_P(CompanionsOfADrive, AreFoundAfterSomeMetres) {
  Companions companions;
  const double step_m = GetParam();
  double way_m = 0.0;
  for (int scan = 0; way_m < 8.0; ++scan, way_m += step_m) {
    const std::vector<float> range_m =
        readings({{1.2 + 0.15 * std::sin(0.3 * way_m), 0.1 * std::cos(way_m)}});
    const auto& beams = companions.observe(scan_of(range_m), {step_m, 0.0, 0.0});
    if (way_m < 2.0) EXPECT_THAT(beams, IsEmpty()) << way_m;
    if (way_m > 5.0) EXPECT_EQ(beams, beams_of(range_m)) << way_m;
  }
}

TEST_P(CompanionsOfADrive, AreNotWhatStands) {
  Companions companions;
  const double step_m = GetParam();
  for (double way_m = 0.0; way_m < 12.0; way_m += step_m) {
    std::vector<Vector2> posts_m;
    for (int post = 0; post < 8; ++post)
      posts_m.emplace_back(2.3 * post - way_m, post % 2 ? 1.4 : -1.4);
    EXPECT_THAT(companions.observe(scan_of(readings(posts_m)), {step_m, 0.0, 0.0}), IsEmpty())
        << way_m;
  }
}

INSTANTIATE_TEST_SUITE_P(Steps, CompanionsOfADrive, ::testing::Values(0.05, 0.3, 0.9));

TEST(Companions, AreNotWhatIsNearAVehicleThatStands) {
  Companions companions;
  for (int scan = 0; scan < 1'000; ++scan)
    EXPECT_THAT(companions.observe(scan_of(readings({{1.2, 0.0}})), {}), IsEmpty());
}

TEST(Companions, AreFoundWhereTheVehicleTurns) {
  Companions companions;
  for (int scan = 0; scan < 20; ++scan)
    companions.observe(scan_of(readings({{1.2, 0.0}})), {0.0, 0.0, 0.4});
  EXPECT_THAT(companions.observe(scan_of(readings({{1.2, 0.0}})), {0.0, 0.0, 0.4}),
              SizeIs(beams_of(readings({{1.2, 0.0}})).size()));
}

TEST(Companions, StayKnownWhileTheyTouchWhatIsBehindThem) {
  Companions companions;
  std::vector<float> range_m = readings({{1.2, 0.0}});
  for (int scan = 0; scan < 20; ++scan) companions.observe(scan_of(range_m), {0.3, 0.0, 0.0});
  for (std::size_t beam = 0; beam < 90; ++beam) range_m[beam] = 1.1F;  // a wall beside them
  for (int scan = 0; scan < 3; ++scan) {
    const auto& beams = companions.observe(scan_of(range_m), {0.3, 0.0, 0.0});
    EXPECT_THAT(beams, ::testing::Contains(std::size_t{90}));
    EXPECT_THAT(beams, ::testing::Not(::testing::Contains(std::size_t{10})));
  }
  for (int scan = 0; scan < 4; ++scan) companions.observe(scan_of(range_m), {0.3, 0.0, 0.0});
  EXPECT_THAT(companions.observe(scan_of(range_m), {0.3, 0.0, 0.0}), IsEmpty());
}

TEST(Companions, AreNotThePartsOfAWall) {
  Companions companions;
  std::vector<float> range_m(kBeams);
  for (std::size_t beam = 0; beam < kBeams; ++beam)  // 1 m to the right, all along
    range_m[beam] =
        beam < 89
            ? static_cast<float>(1.0 / std::sin((90.0 - static_cast<double>(beam)) * kStepRad))
            : 30.0F;
  for (int scan = 0; scan < 100; ++scan)
    EXPECT_THAT(companions.observe(scan_of(range_m), {0.1, 0.0, 0.0}), IsEmpty());
}

TEST(Companions, AreNotFoundInScansWithoutAnEcho) {
  Companions companions;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float reading : {nan, 0.0F, -1.0F, 80.0F})
    EXPECT_THAT(companions.observe(scan_of(std::vector<float>(kBeams, reading)), {1.0, 0.0, 0.0}),
                IsEmpty());
  EXPECT_THAT(companions.observe(scan_of({}), {1.0, 0.0, 0.0}), IsEmpty());
}

}  // namespace
}  // namespace slammot::sensing
