#include "common/files/log_profile.hpp"

#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slammot::files {
namespace {

using std::numbers::pi;
using ::testing::HasSubstr;

TEST(ChooseProfile, SendsFastVehiclesToTheStreet) {
  const auto choice =
      choose_profile({.has_clock = true, .far_range_m = 10.0, .cruising_speed_mps = 12.0});
  EXPECT_EQ(choice.profile, "urban");
  EXPECT_THAT(choice.reason, HasSubstr("12.0 m/s"));
}

TEST(ChooseProfile, TakesSlowVehiclesAmongFarEchoesForRobotsInTheOpen) {
  EXPECT_EQ(
      choose_profile({.has_clock = true, .far_range_m = 52.0, .cruising_speed_mps = 1.0}).profile,
      "outdoor_robot");
}

TEST(ChooseProfile, KeepsSlowRobotsAmongNearWallsInsideEvenWithALongRangeScanner) {
  const auto choice = choose_profile(
      {.has_clock = true, .max_range_m = 81.83, .far_range_m = 5.8, .cruising_speed_mps = 0.3});
  EXPECT_EQ(choice.profile, "indoor");
  EXPECT_THAT(choice.reason, HasSubstr("5.8 m"));
}

TEST(ChooseProfile, GoesByTheRangesWithoutAClock) {
  EXPECT_EQ(choose_profile({.far_range_m = 5.8}).profile, "indoor");
  EXPECT_EQ(choose_profile({.comes_by_time = true, .far_range_m = 45.0}).profile, "urban");
}

TEST(ChooseProfile, TakesScansForEachPieceOfWayForThoseOfARobot) {
  EXPECT_EQ(choose_profile({.comes_by_time = false, .far_range_m = 45.0}).profile, "outdoor_robot");
}

constexpr LogFigures kSpinning{.beams = 360,
                               .has_clock = true,
                               .field_of_view_rad = 2.0 * pi,
                               .scan_period_s = 0.08,
                               .scan_period_spread = 0.1};

TEST(SweepTime, IsTheScanPeriodOfAScannerThatSpinsSteadily) {
  EXPECT_NEAR(sweep_s_for(kSpinning, 0.013), 0.08 * 359.0 / 360.0, 1e-12);
}

TEST(SweepTime, IsTheShareOfATurnOfAScannerThatLooksBehindItself) {
  LogFigures wide = kSpinning;
  wide.field_of_view_rad = 1.5 * pi;
  wide.scan_period_s = 0.025;
  EXPECT_NEAR(sweep_s_for(wide, 0.0), 0.75 * 0.025 * 359.0 / 360.0, 1e-12);
  wide.scan_period_s = 0.2;  // its mirror is faster
  EXPECT_EQ(sweep_s_for(wide, 0.013), 0.013);
}

TEST(SweepTime, IsTheProfilesForOthers) {
  LogFigures half = kSpinning;
  half.field_of_view_rad = pi;
  EXPECT_EQ(sweep_s_for(half, 0.013), 0.013);
  LogFigures thinned = kSpinning;
  thinned.scan_period_s = 1.0;
  EXPECT_EQ(sweep_s_for(thinned, 0.013), 0.013);
  LogFigures unsteady = kSpinning;
  unsteady.scan_period_spread = 1.0;
  EXPECT_EQ(sweep_s_for(unsteady, 0.013), 0.013);
  LogFigures without_clock = kSpinning;
  without_clock.has_clock = false;
  EXPECT_EQ(sweep_s_for(without_clock, 0.013), 0.013);
}

TEST(SweepTime, NeverOutlastsThePeriod) {
  EXPECT_EQ(sweep_s_for({.field_of_view_rad = pi, .scan_period_s = 0.01}, 0.013), 0.01);
}

TEST(SweepTime, KeepsItsShareOfAPeriodThatIsMadeUp) {
  const LogFigures half_circle{.beams = 361,
                               .has_clock = false,
                               .comes_by_time = true,
                               .field_of_view_rad = pi,
                               .scan_period_s = 0.1};
  EXPECT_NEAR(sweep_s_for(half_circle, 0.0133), 0.05, 1e-12);
  EXPECT_EQ(sweep_s_for(half_circle, 0.0), 0.0);
}

}  // namespace
}  // namespace slammot::files
