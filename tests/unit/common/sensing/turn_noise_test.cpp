#include "common/sensing/turn_noise.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace slammot::sensing {
namespace {

constexpr double kPeriod_s = 1.0 / 37.5;

struct Errors {
  double of_turn_rad = 0.0;  ///< White, of each turn by the wheels.
  double of_scan_rad = 0.0;  ///< White, of each scan's heading.
  double tick_rad = 0.0;     ///< The heading by the wheels is counted in these.
};

/// One sigma of the noise that is found [rad] of a vehicle that winds along a road.
double noise_found(const Errors& errors, int scans = 600) {
  std::mt19937 random(3);
  std::normal_distribution<double> unit;
  TurnNoise noise;
  double heading_rad = 0.0;
  double counted_rad = 0.0;
  for (int scan = 0; scan < scans; ++scan) {
    const double turn_rad = 0.4 * kPeriod_s * std::sin(0.5 * scan * kPeriod_s);
    heading_rad += turn_rad;
    double by_wheels_rad = turn_rad + errors.of_turn_rad * unit(random);
    if (errors.tick_rad > 0.0) {
      const double before_rad = counted_rad;
      counted_rad = errors.tick_rad * std::floor(heading_rad / errors.tick_rad);
      by_wheels_rad = counted_rad - before_rad;
    }
    noise.add(std::remainder(heading_rad + errors.of_scan_rad * unit(random), 6.283185307179586),
              by_wheels_rad, kPeriod_s);
  }
  return std::sqrt(noise.variance_in(kPeriod_s));
}

TEST(TurnNoise, IsTheNoiseOfTheWheelsTurns) {
  EXPECT_NEAR(noise_found({.of_turn_rad = 0.0016}), 0.0016, 0.0003);
  EXPECT_NEAR(noise_found({.of_turn_rad = 0.0003}), 0.0003, 0.0001);
  EXPECT_NEAR(noise_found({.of_turn_rad = 0.0016, .of_scan_rad = 0.001}), 0.0016, 0.0004);
}

TEST(TurnNoise, IsNotThatOfTheScans) {
  EXPECT_LT(noise_found({.of_turn_rad = 0.0003, .of_scan_rad = 0.001}), 0.0006);
}

TEST(TurnNoise, IsThatOfCoarseEncoders) { EXPECT_GT(noise_found({.tick_rad = 0.0067}), 0.002); }

TEST(TurnNoise, IsNotKnownOfAFewScans) { EXPECT_EQ(noise_found({.of_turn_rad = 0.0016}, 10), 0.0); }

TEST(TurnNoise, IsNotToldAcrossScansThatTellNothing) {
  TurnNoise noise;
  for (int scan = 0; scan < 100; ++scan) {
    noise.add(0.1 * scan, 0.0, kPeriod_s);
    if (scan % 2 == 1) noise.interrupt();
  }
  EXPECT_EQ(noise.variance_in(kPeriod_s), 0.0);
}

TEST(TurnNoise, IsNotSoundWithWhatNoWheelsSay) {
  TurnNoise noise;
  EXPECT_TRUE(noise.is_sound());
  noise.add(0.1, 0.1, kPeriod_s);
  EXPECT_TRUE(noise.is_sound());
  noise.add(std::numeric_limits<double>::quiet_NaN(), 0.1, kPeriod_s);
  EXPECT_FALSE(noise.is_sound());
}

}  // namespace
}  // namespace slammot::sensing
