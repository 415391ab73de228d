#include "common/sensing/repeated_lines.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace slammot::sensing {
namespace {

using geometry::Vector2;

/// Scans of walls that are elsewhere in each scan, in front of or behind one line that is not.
InverseScans scans_with_line(const Vector2& line_per_m, double sway) {
  constexpr double kStep_rad = 0.02;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
  std::normal_distribution<double> noise;
  InverseScans scans;
  scans.beam_step_rad = kStep_rad;
  for (int beam = -70; beam <= 70; ++beam)
    scans.direction.emplace_back(std::cos(kStep_rad * beam), std::sin(kStep_rad * beam));
  for (int scan = 0; scan < 60; ++scan) {
    const Vector2 wall = 0.3 * Vector2(anywhere(random), anywhere(random));
    const Vector2 line = line_per_m * (1.0 + sway * noise(random));
    std::vector<double>& per_m = scans.per_m.emplace_back();
    for (const Vector2& direction : scans.direction)
      per_m.push_back(std::max({0.0, wall.dot(direction), line.dot(direction)}));
  }
  return scans;
}

TEST(RepeatedLines, BeginWithTheLineThatMostScansHave) {
  const Vector2 line(0.18, 0.05);
  const RepeatedLine found = repeated_lines(scans_with_line(line, 0.0)).front();
  EXPECT_LT((found.inverse_per_m - line).norm(), 0.002);
  EXPECT_LT(found.spread, 0.01);
  EXPECT_GT(found.scans, 40U);
}

TEST(RepeatedLines, TellHowMuchALineSways) {
  const Vector2 line(0.18, 0.05);
  const RepeatedLine found = repeated_lines(scans_with_line(line, 0.03)).front();
  EXPECT_LT((found.inverse_per_m - line).norm(), 0.01);
  EXPECT_NEAR(found.spread, 0.03, 0.015);
}

TEST(RepeatedLines, AreNoneOfInterestWhereNoBeamHasAnEcho) {
  InverseScans scans = scans_with_line({0.18, 0.05}, 0.0);
  for (std::vector<double>& per_m : scans.per_m) std::ranges::fill(per_m, 0.0);
  for (const RepeatedLine& line : repeated_lines(scans)) EXPECT_GT(line.spread, 0.1);
}

}  // namespace
}  // namespace slammot::sensing
