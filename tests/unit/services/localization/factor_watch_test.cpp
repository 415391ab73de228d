#include "services/localization/factor_watch.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "services/localization/localizer.hpp"
#include "tests/support/localizer_drive.hpp"

namespace slammot::localization {
namespace {

using geometry::Pose2;
using slammot::testing::all_stationary;
using slammot::testing::DriveSetup;
using slammot::testing::SimulatedDrive;
using slammot::testing::small_map_config;
using slammot::testing::stamp_ns_of;

FactorRatios ratios_about(double middle, double apart, std::size_t count) {
  FactorRatios ratios;
  for (std::size_t i = 0; i < count; ++i)
    ratios.add(middle + apart * (static_cast<double>(i % 3) - 1.0));
  return ratios;
}

TEST(FactorRatios, TellAFactorThatMostAgreeOn) {
  FactorRatios ratios = ratios_about(1.4, 0.02, 6);
  ratios.add(1.0);
  const auto found = ratios.other_than(1.0);
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found, 1.4, 0.03);
  EXPECT_FALSE(ratios.other_than(1.4));
}

TEST(FactorRatios, TellNothingByFewOrScatteredOnes) {
  EXPECT_FALSE(ratios_about(1.4, 0.02, 5).other_than(1.0));
  EXPECT_FALSE(ratios_about(1.4, 0.4, 9).other_than(1.0));
}

TEST(FactorRatios, TellNothingOfScansThatSeemNotToHaveMoved) {
  EXPECT_FALSE(ratios_about(0.1, 0.01, 9).other_than(1.0));
}

TEST(FactorRatios, AreSettledOnceEnoughAgreeWithTheOneInUse) {
  const auto is_settled = [](FactorRatios ratios) {
    ratios.settle(1.0);
    return ratios.is_settled();
  };
  EXPECT_FALSE(is_settled(ratios_about(1.0, 0.02, 8)));
  EXPECT_TRUE(is_settled(ratios_about(1.0, 0.02, 16)));
  EXPECT_FALSE(is_settled(ratios_about(1.4, 0.02, 16)));
}

TEST(FactorRatios, SayNothingOfAnotherFactorOnceTheyAreSettled) {
  FactorRatios ratios = ratios_about(1.0, 0.02, 16);
  ratios.settle(1.0);
  EXPECT_FALSE(ratios.other_than(1.5));
}

/// A street along which a vehicle weaves.
DriveSetup weaving_along() {
  DriveSetup setup{.world = slammot::testing::street(160.0)};
  setup.world_from_base_at = [](double time_s) {
    constexpr double kAside_m = 1.0, kPerMetre_rad = 0.35, kSpeed_mps = 4.0;
    const double x_m = kSpeed_mps * time_s;
    return Pose2{x_m, kAside_m * std::sin(kPerMetre_rad * x_m),
                 std::atan(kAside_m * kPerMetre_rad * std::cos(kPerMetre_rad * x_m))};
  };
  setup.scan_period_s = 0.04;
  return setup;
}

struct FactoredDrive {
  sensing::WheelFactors factors;
  std::uint64_t recalibrations = 0;
};

/// With wheels that count so much of each way and turn.
FactoredDrive drive_with_factors(double way, double turn, bool watches) {
  SimulatedDrive drive(weaving_along());
  LocalizerConfig config = small_map_config();
  config.map.side_m = 160.0;
  config.odometry.watches_factors = watches;
  Localizer localizer(config);
  Pose2 wheel_from_base;
  for (std::uint32_t scan = 0; scan < 150; ++scan) {
    if (scan > 0) {
      const Pose2 step =
          geometry::inverse(drive.odom_from_base(scan - 1)) * drive.odom_from_base(scan);
      wheel_from_base =
          wheel_from_base * Pose2{way * step.x_m, way * step.y_m, turn * step.heading_rad};
    }
    localizer.add_odometry({stamp_ns_of(drive.time_s(scan)), wheel_from_base});
    if (const auto localized = localizer.localize(drive.scan(scan)))
      localizer.integrate(all_stationary(*localized));
  }
  return {localizer.odometry_conclusions().total, localizer.counters().odometry.recalibrations};
}

TEST(FactorWatch, FindsTheFactorOfTheWayWithinSeconds) {
  for (const double way : {0.7, 1.3}) {
    const FactoredDrive result = drive_with_factors(way, 1.0, true);
    EXPECT_GE(result.recalibrations, 1U) << way;
    EXPECT_NEAR(result.factors.way * way, 1.0, 0.05);
  }
}

TEST(FactorWatch, FindsNothingWhereItIsOff) {
  EXPECT_EQ(drive_with_factors(0.7, 1.0, false).recalibrations, 0U);
}

TEST(FactorWatch, EndsAlsoWhereScansTellNothing) {
  FactorWatch watch;
  const std::string scanner = "front";
  const std::vector<matching::MatchPoint> nothing;
  Pose2 wheel_from_base;
  while (!watch.has_ended()) {
    ASSERT_LT(wheel_from_base.x_m, 1000.0);
    wheel_from_base.x_m += 1.1;
    EXPECT_FALSE(watch.observe({scanner, wheel_from_base, nothing}, {}));
  }
  EXPECT_EQ(watch.ways(), 0U);
}

TEST(FactorWatch, FindsNothingInSoundOdometry) {
  EXPECT_EQ(drive_with_factors(1.0, 1.0, true).recalibrations, 0U);
}

}  // namespace
}  // namespace slammot::localization
