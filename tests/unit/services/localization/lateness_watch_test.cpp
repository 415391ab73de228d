#include "services/localization/lateness_watch.hpp"

#include <cmath>
#include <functional>

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
using slammot::testing::small_map_config;
using slammot::testing::stamp_ns_of;

constexpr double kPeriod_s = 0.04;

/// A street along which a vehicle weaves.
DriveSetup weaving() {
  DriveSetup setup{.world = slammot::testing::street(160.0)};
  setup.world_from_base_at = [](double time_s) {
    constexpr double kAside_m = 1.0, kPerMetre_rad = 0.35, kSpeed_mps = 4.0;
    const double x_m = kSpeed_mps * time_s;
    return Pose2{x_m, kAside_m * std::sin(kPerMetre_rad * x_m),
                 std::atan(kAside_m * kPerMetre_rad * std::cos(kPerMetre_rad * x_m))};
  };
  setup.scan_period_s = kPeriod_s;
  return setup;
}

struct DriveResult {
  LocalizerCounters counters;
  bool is_applied = false;
  double offset_s = 0.0;
  double error_m = 0.0;  ///< Of the last pose.
};

/// Lateness of odometry by time.
using Lateness = std::function<double(double time_s)>;

DriveResult drive_with(const Lateness& late_s, std::uint32_t scans, LocalizerConfig config,
                       std::uint32_t every = 1) {
  const DriveSetup setup = weaving();
  SimulatedDrive drive(setup);
  Localizer localizer(config);
  DriveResult result;
  for (std::uint32_t scan = 0; scan < scans; ++scan) {
    const double time_s = drive.time_s(scan);
    if (scan % every == 0)
      localizer.add_odometry(
          {stamp_ns_of(time_s), setup.world_from_base_at(time_s - late_s(time_s))});
    const auto localized = localizer.localize(drive.scan(scan));
    if (!localized) continue;
    localizer.integrate(all_stationary(*localized));
    result.error_m = distance_m(localized->odom_from_base.pose, drive.odom_from_base(scan));
  }
  result.counters = localizer.counters();
  result.is_applied = localizer.applies_stamp_offset();
  result.offset_s = result.is_applied ? localizer.stamp_offset_s() : 0.0;
  return result;
}

Lateness always(double late_s) {
  return [=](double) { return late_s; };
}

/// Without what the filter learns of the offset.
LocalizerConfig config_of_watch() {
  LocalizerConfig config = small_map_config();
  config.map.side_m = 160.0;
  config.motion.stamp_offset_prior_s = 1e-4;
  return config;
}

TEST(LatenessWatch, FindsHowLateOrEarlyOdometryIsWhileDriving) {
  for (const double late_s : {-0.1, 0.1, 0.3}) {
    const DriveResult result = drive_with(always(late_s), 600, config_of_watch());
    EXPECT_GE(result.counters.odometry.retimed, 1U) << late_s;
    EXPECT_TRUE(result.is_applied) << late_s;
    EXPECT_NEAR(result.offset_s, late_s, 0.1 * std::abs(late_s) + 0.01);
    EXPECT_EQ(result.counters.map.astray, 0U);
  }
}

TEST(LatenessWatch, ChangesNothingWhereOdometryIsInTime) {
  LocalizerConfig off = config_of_watch();
  off.odometry.watches_lateness = false;
  const DriveResult with = drive_with(always(0.0), 600, config_of_watch());
  const DriveResult without = drive_with(always(0.0), 600, off);
  EXPECT_EQ(with.counters.odometry.retimed, 0U);
  EXPECT_EQ(with.error_m, without.error_m);
}

TEST(LatenessWatch, TakesItBackWhereOdometryComesInTimeAgain) {
  const DriveResult result =
      drive_with([](double time_s) { return time_s < 14.0 ? 0.15 : 0.0; }, 900, config_of_watch());
  EXPECT_GE(result.counters.odometry.retimed, 2U);
  EXPECT_NEAR(result.offset_s, 0.0, 0.015);
}

TEST(LatenessWatch, SaysNothingOfOdometryThatComesSeldom) {
  const DriveResult result = drive_with(always(0.0), 600, config_of_watch(), 5);
  EXPECT_EQ(result.counters.odometry.retimed, 0U);
}

}  // namespace
}  // namespace slammot::localization
