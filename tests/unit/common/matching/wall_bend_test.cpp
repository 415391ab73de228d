#include "common/matching/wall_bend.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace slammot::matching {
namespace {

constexpr std::size_t kBeams = 181;

/// Scans of a half circle in a room of 9 m by 7 m, from several places and headings.
std::vector<std::vector<float>> scans_of_a_room(double noise_m) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, noise_m);
  std::vector<std::vector<float>> scans;
  for (int place = 0; place < 12; ++place) {
    const double x_m = 2.0 + 0.4 * place;
    const double y_m = 2.0 + 0.2 * place;
    std::vector<float> ranges;
    for (std::size_t beam = 0; beam < kBeams; ++beam) {
      const double direction_rad =
          0.5 * place + std::numbers::pi * (static_cast<double>(beam) / (kBeams - 1) - 0.5);
      const double dx = std::cos(direction_rad);
      const double dy = std::sin(direction_rad);
      const double to_x_m = dx > 0.0 ? (9.0 - x_m) / dx : -x_m / dx;
      const double to_y_m = dy > 0.0 ? (7.0 - y_m) / dy : -y_m / dy;
      ranges.push_back(static_cast<float>(std::min(to_x_m, to_y_m) + noise(random)));
    }
    scans.push_back(std::move(ranges));
  }
  return scans;
}

WallBend bend_of_field(double degrees, double noise_m = 0.01) {
  const double field_rad = degrees * std::numbers::pi / 180.0;
  return wall_bend(scans_of_a_room(noise_m), -0.5 * field_rad, field_rad / (kBeams - 1));
}

TEST(WallBend, IsLeastForTheFieldOfView) {
  const double right = std::abs(bend_of_field(180.0).bend);
  for (const double degrees : {90.0, 120.0, 150.0, 210.0, 240.0, 270.0})
    EXPECT_GT(std::abs(bend_of_field(degrees).bend), 2.0 * right) << degrees;
  EXPECT_GT(bend_of_field(180.0).windows, 50U);
}

TEST(WallBend, HasOneSignForBeamsTooNarrowAndTheOtherForBeamsTooWide) {
  EXPECT_GT(bend_of_field(135.0).bend, 0.001);
  EXPECT_LT(bend_of_field(225.0).bend, -0.001);
}

TEST(WallBend, OfTheRightFieldIsWithinItsSigmas) {
  const WallBend right = bend_of_field(180.0);
  EXPECT_LT(std::abs(right.bend), 3.0 * right.sigma);
  const WallBend wide = bend_of_field(240.0);
  EXPECT_GT(std::abs(wide.bend), 5.0 * wide.sigma);
}

TEST(WallBend, MeasuresNothingWithoutWalls) {
  const std::vector<std::vector<float>> blind(
      5, std::vector<float>(kBeams, std::numeric_limits<float>::quiet_NaN()));
  EXPECT_EQ(wall_bend(blind, -1.5, 0.017).windows, 0U);
  EXPECT_EQ(wall_bend({}, -1.5, 0.017).windows, 0U);
  EXPECT_EQ(
      wall_bend(std::vector<std::vector<float>>(1, std::vector<float>{2.0F}), 0.0, 0.017).windows,
      0U);
}

}  // namespace
}  // namespace slammot::matching
