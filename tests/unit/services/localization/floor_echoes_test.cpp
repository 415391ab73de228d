#include "services/localization/floor_echoes.hpp"

#include <gtest/gtest.h>

#include "tests/support/tilted_scanner.hpp"

namespace slammot::localization {
namespace {

using geometry::Pose2;
using testing::kHalfCircle;
using testing::TiltedScanner;

constexpr std::size_t kAhead = 90;  // the beam

/// A scanner of the vehicle, with scans from its drive in curves.
class ScannedHall {
 public:
  ScannedHall(std::string scanner_id, const testing::FloorHall& hall) : hall_(hall) {
    scan_.scanner.scanner_id = std::move(scanner_id);
    scan_.scanner.first_beam_rad = kHalfCircle.first_beam_rad;
    scan_.scanner.beam_step_rad = kHalfCircle.beam_step_rad;
    scan_.scanner.max_range_m = static_cast<float>(kHalfCircle.no_echo_m);
  }

  Pose2 pose() const { return hall_.pose(step_); }
  const sensing::LaserScan& next() {
    scan_.range_m = hall_.scan(hall_.pose(++step_));
    return scan_;
  }

 private:
  TiltedScanner hall_;
  sensing::LaserScan scan_;
  int step_ = 0;
};

/// Scans until the floor is found; none if it is not within 2000.
std::optional<int> scans_to_find(FloorEchoes& echoes, ScannedHall& hall, bool has_odometry) {
  for (int scans = 1; scans <= 2000; ++scans) {
    const sensing::LaserScan& scan = hall.next();
    echoes.leave_out(scan, has_odometry ? std::optional(hall.pose()) : std::nullopt);
    if (echoes.found_now()) return scans;
  }
  return std::nullopt;
}

TEST(FloorEchoes, AreFoundWithinTenMetresAndLeftOutFromThenOn) {
  FloorEchoes echoes;
  ScannedHall hall("front", {.floor = {0.2, 0.0}});
  const std::optional<int> scans = scans_to_find(echoes, hall, true);
  ASSERT_TRUE(scans.has_value());
  EXPECT_LT(*scans, 200);
  EXPECT_NEAR(echoes.found_now()->distance_m, 5.0, 0.1);
  const sensing::LaserScan& scan = hall.next();
  EXPECT_LT(echoes.leave_out(scan, hall.pose()).range_m[kAhead], 0.01);
  EXPECT_FALSE(echoes.found_now().has_value()) << "it is told once";
  EXPECT_LT(echoes.without_floor(scan).range_m[kAhead], 0.01);
  EXPECT_GT(scan.range_m[kAhead], 1.0);
}

TEST(FloorEchoes, AreThoseOfTheirScanner) {
  FloorEchoes echoes;
  ScannedHall front("front", {.floor = {0.2, 0.0}});
  ScannedHall rear("rear", {});
  ASSERT_TRUE(scans_to_find(echoes, front, true).has_value());
  EXPECT_FALSE(scans_to_find(echoes, rear, true).has_value());
  const sensing::LaserScan& scan = rear.next();
  EXPECT_EQ(&echoes.leave_out(scan, rear.pose()), &scan) << "the scan itself";
}

TEST(FloorEchoes, AreNotThoseOfALineBesideTheVehicle) {
  FloorEchoes echoes;
  ScannedHall hall("front", {.floor = {0.05, 0.25}});
  EXPECT_FALSE(scans_to_find(echoes, hall, true).has_value());
}

TEST(FloorEchoes, AreNotFoundWithoutOdometry) {
  FloorEchoes echoes;
  ScannedHall hall("front", {.floor = {0.2, 0.0}});
  EXPECT_FALSE(scans_to_find(echoes, hall, false).has_value());
}

}  // namespace
}  // namespace slammot::localization
