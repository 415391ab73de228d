#include "common/sensing/wheel_speed_change.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <random>

#include <gtest/gtest.h>

namespace slammot::sensing {
namespace {

constexpr double kChangeScanPeriod_s = 1.0 / 37.5;

struct FoundChange {
  int step = 0;
  double by_mps = 0.0;
};

/// The first change that is found in so many steps of a vehicle. sigma_mps: white noise of a step.
std::optional<FoundChange> first_change(const std::function<double(double time_s)>& speed_mps,
                                        double sigma_mps, int steps, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise_mps(0.0, sigma_mps);
  WheelSpeedChange change;
  for (int step = 0; step < steps; ++step) {
    const double counted_mps = speed_mps(step * kChangeScanPeriod_s) + noise_mps(random);
    if (const auto by_mps = change.observe(counted_mps, kChangeScanPeriod_s))
      return FoundChange{step, *by_mps};
  }
  return std::nullopt;
}

/// Sets off at 2 s with 3 m/s^2, brakes with 4 m/s^2 to a stand from 7 s on, and so on.
double stop_and_go_mps(double time_s) {
  const double phase_s = std::fmod(time_s, 12.0);
  if (phase_s < 2.0) return 0.0;
  if (phase_s < 6.0) return 3.0 * (phase_s - 2.0);
  if (phase_s < 7.0) return 12.0;
  return std::max(0.0, 12.0 - 4.0 * (phase_s - 7.0));
}

TEST(WheelSpeedChange, IsFoundWithinThreeStepsWithItsSize) {
  constexpr int kFrom = 100;
  for (const double slip_mps : {0.7, -1.0, 1.0, 3.0, -3.0}) {
    const auto found = first_change(
        [&](double time_s) {
          return 8.0 + 1.5 * time_s +
                 (time_s > (kFrom - 0.5) * kChangeScanPeriod_s ? slip_mps : 0.0);
        },
        0.03, 200);
    ASSERT_TRUE(found) << slip_mps;
    EXPECT_GE(found->step, kFrom + 1);
    EXPECT_LE(found->step, kFrom + 2);
    EXPECT_NEAR(found->by_mps, slip_mps, 0.2);
  }
}

TEST(WheelSpeedChange, IsNotAVehicleThatSetsOffAndBrakes) {
  EXPECT_FALSE(first_change(stop_and_go_mps, 0.03, 4000));
}

TEST(WheelSpeedChange, IsNotNoiseOfTheSteps) {
  for (const double sigma_mps : {0.1, 0.2, 0.4, 1.0})
    EXPECT_FALSE(first_change([](double) { return 12.0; }, sigma_mps, 300)) << sigma_mps;
}

TEST(WheelSpeedChange, IsNotOneStepThatTheNextOneTakesBack) {
  EXPECT_FALSE(first_change(
      [](double time_s) {
        const int step = static_cast<int>(std::lround(time_s / kChangeScanPeriod_s));
        return step == 60 ? 13.0 : step == 61 ? 7.0 : 10.0;
      },
      0.03, 200));
}

TEST(WheelSpeedChange, IsLookedForAnewAfterAnInterruption) {
  WheelSpeedChange change;
  for (int step = 0; step < 30; ++step) change.observe(5.0, kChangeScanPeriod_s);
  change.begin_anew();
  for (int step = 0; step < 10; ++step) EXPECT_FALSE(change.observe(7.0, kChangeScanPeriod_s));
}

TEST(WheelSpeedChange, KnowsAStateThatCannotBe) {
  WheelSpeedChange change;
  change.observe(1.0, kChangeScanPeriod_s);
  EXPECT_TRUE(change.is_sound());
  change.observe(std::numeric_limits<double>::quiet_NaN(), kChangeScanPeriod_s);
  EXPECT_FALSE(change.is_sound());
}

}  // namespace
}  // namespace slammot::sensing
