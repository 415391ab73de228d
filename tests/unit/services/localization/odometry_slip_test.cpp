#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "services/localization/localizer.hpp"
#include "tests/support/localizer_drive.hpp"

namespace slammot::localization {
namespace {

using geometry::Pose2;
using slammot::testing::all_stationary;
using slammot::testing::distance_m;
using slammot::testing::DriveSetup;
using slammot::testing::SimulatedDrive;
using slammot::testing::stamp_ns_of;

constexpr double kScanPeriodOfACar_s = 0.027;

/// A car that drives along a street.
DriveSetup car_of_many_scans(double speed_mps) {
  DriveSetup setup{.world = slammot::testing::street(160.0)};
  setup.world_from_base_at = [=](double time_s) { return Pose2{speed_mps * time_s, 0.0, 0.0}; };
  setup.scan_period_s = kScanPeriodOfACar_s;
  return setup;
}

/// The car, which brakes at 2 s with 4 m/s^2 and stands from 4 s on.
DriveSetup car_that_stops() {
  constexpr double kSpeed_mps = 8.0, kBrakes_s = 2.0, kBraking_mps2 = 4.0;
  DriveSetup setup = car_of_many_scans(kSpeed_mps);
  setup.world_from_base_at = [=](double time_s) {
    const double braking_s = std::clamp(time_s - kBrakes_s, 0.0, kSpeed_mps / kBraking_mps2);
    const double way_m = kSpeed_mps * (std::min(time_s, kBrakes_s) + braking_s) -
                         0.5 * kBraking_mps2 * braking_s * braking_s;
    return Pose2{way_m, 0.0, 0.0};
  };
  return setup;
}

struct Slip {
  double from_s = 0.0;
  double until_s = 0.0;
  double mps = 0.0;
};

struct SlipResult {
  double worst_m = 0.0;
  double last_m = 0.0;
  std::uint64_t withheld_scans = 0;
};

/// The worst and the last error of the pose where wheels slip and have no other error.
SlipResult drive_with_slip(const DriveSetup& setup, const Slip& slip, double duration_s) {
  SimulatedDrive drive(setup);
  Localizer localizer(slammot::testing::small_map_config());
  SlipResult result;
  Pose2 wheel_from_base;
  const auto scans = static_cast<std::uint32_t>(duration_s / kScanPeriodOfACar_s);
  for (std::uint32_t scan = 0; scan < scans; ++scan) {
    const Pose2 truth = drive.odom_from_base(scan);
    if (scan > 0) {
      Pose2 step = geometry::inverse(drive.odom_from_base(scan - 1)) * truth;
      const double time_s = drive.time_s(scan);
      if (time_s > slip.from_s && time_s <= slip.until_s)
        step.x_m += slip.mps * kScanPeriodOfACar_s;
      wheel_from_base = wheel_from_base * step;
    }
    localizer.add_odometry({stamp_ns_of(drive.time_s(scan)), wheel_from_base});
    const auto localized = localizer.localize(drive.scan(scan));
    if (!localized) continue;
    localizer.integrate(all_stationary(*localized));
    result.last_m = distance_m(localized->odom_from_base.pose, truth);
    result.worst_m = std::max(result.worst_m, result.last_m);
  }
  result.withheld_scans = localizer.counters().map.withheld_scans;
  return result;
}

TEST(OdometrySlip, DoesNotCarryThePoseAwayWhileTheVehicleDrives) {
  for (const double mps : {1.0, -1.0}) {
    const SlipResult result =
        drive_with_slip(car_of_many_scans(8.0), {.from_s = 4.0, .until_s = 8.0, .mps = mps}, 10.0);
    EXPECT_LT(result.worst_m, 0.25) << mps;
    EXPECT_LT(result.last_m, 0.1) << mps;
  }
}

TEST(OdometrySlip, DoesNotCarryThePoseAwayWhileTheVehicleStands) {
  const SlipResult result =
      drive_with_slip(car_that_stops(), {.from_s = 5.5, .until_s = 9.5, .mps = 1.0}, 11.0);
  EXPECT_LT(result.worst_m, 0.15);
  EXPECT_LT(result.last_m, 0.05);
}

TEST(OdometrySlip, KeepsScansOutOfTheMapForASecondAtItsBeginningAndItsEndOnly) {
  const DriveSetup car = car_of_many_scans(8.0);
  const SlipResult sound = drive_with_slip(car, {}, 6.0);
  EXPECT_EQ(sound.withheld_scans, 0U);
  const SlipResult slipping =
      drive_with_slip(car, {.from_s = 2.0, .until_s = 5.0, .mps = 1.0}, 7.0);
  EXPECT_GT(slipping.withheld_scans, 0U);
  EXPECT_LE(slipping.withheld_scans, static_cast<std::uint64_t>(2.1 / kScanPeriodOfACar_s));
}

}  // namespace
}  // namespace slammot::localization
