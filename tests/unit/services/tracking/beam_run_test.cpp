#include "services/tracking/beam_run.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace slammot::tracking {
namespace {

/// A scan with these ranges, over half a circle or a full one.
PolarView view_of(const std::vector<float>& range_m, double field_of_view_rad) {
  flow::SegmentedScan scan;
  scan.beam_step_rad = field_of_view_rad / static_cast<double>(range_m.size());
  scan.range_m = range_m;
  for (std::size_t beam = 0; beam < range_m.size(); ++beam) {
    const double angle_rad = static_cast<double>(beam) * scan.beam_step_rad;
    scan.points_in_base_m.push_back(range_m[beam] *
                                    Eigen::Vector2f(static_cast<float>(std::cos(angle_rad)),
                                                    static_cast<float>(std::sin(angle_rad))));
  }
  return PolarView(scan);
}

TEST(BeamRun, GoesFromTheFirstToTheLastBeam) {
  const BeamRun run = run_of({3, 4, 7}, view_of(std::vector<float>(20, 10.0F), std::numbers::pi));
  EXPECT_EQ(run.start, 0U);
  EXPECT_EQ(run.first, 3);
  EXPECT_EQ(run.last, 7);
}

TEST(BeamRun, BeginsAfterTheWidestGapAcrossTheSeam) {
  const BeamRun run =
      run_of({0, 1, 18, 19}, view_of(std::vector<float>(20, 10.0F), 2.0 * std::numbers::pi));
  EXPECT_EQ(run.start, 2U);
  EXPECT_EQ(run.first, 18);
  EXPECT_EQ(run.last, 1);
}

TEST(BeamRun, HasTheBeamsWithoutEchoBetweenItsEndsAsGaps) {
  std::vector<float> range_m(20, 10.0F);
  range_m[5] = range_m[6] = range_m[12] = 0.0F;
  EXPECT_EQ(gaps_between({4, 7}, view_of(range_m, std::numbers::pi)), 2);
  EXPECT_EQ(gaps_between({7, 8}, view_of(range_m, std::numbers::pi)), 0);
}

TEST(BeamRun, IsApartFromAnotherIfBeamsPassBeyondBothBetweenThem) {
  std::vector<float> range_m(20, 10.0F);
  const std::vector<std::uint16_t> a = {3, 4};
  const std::vector<std::uint16_t> b = {8, 9};
  EXPECT_FALSE(is_seen_between(a, b, view_of(range_m, std::numbers::pi)));
  range_m[5] = range_m[6] = 30.0F;
  EXPECT_TRUE(is_seen_between(a, b, view_of(range_m, std::numbers::pi)));
  EXPECT_TRUE(is_seen_between(b, a, view_of(range_m, std::numbers::pi)));
  range_m[5] = 0.0F;
  EXPECT_FALSE(is_seen_between(a, b, view_of(range_m, std::numbers::pi)))
      << "one beam may be a mixed pixel";
}

}  // namespace
}  // namespace slammot::tracking
