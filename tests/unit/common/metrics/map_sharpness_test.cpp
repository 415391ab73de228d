#include "common/metrics/map_sharpness.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace slammot::metrics {
namespace {

using geometry::Pose2;
using geometry::Vector2;

constexpr double kCellM = 0.05;

TEST(EndCounts, OfNothingKnowsNoCell) {
  const MapSharpness sharpness = EndCounts(kCellM).sharpness();
  EXPECT_EQ(sharpness.touched_cells, 0U);
  EXPECT_EQ(sharpness.mean_entropy_bits(), 0.0);
}

TEST(EndCounts, ABeamPassesEveryCellBeforeTheOneItEndsIn) {
  EndCounts counts(1.0);
  counts.add({0.5, 0.5}, {-3.5, 0.5});
  const MapSharpness sharpness = counts.sharpness();
  EXPECT_EQ(sharpness.touched_cells, 5U);
  EXPECT_EQ(sharpness.occupied_cells, 1U);
  // once met: 1/4 or 3/4
  const double once_bits = -0.25 * std::log2(0.25) - 0.75 * std::log2(0.75);
  EXPECT_NEAR(sharpness.entropy_bits, 5 * once_bits, 1e-12);
}

TEST(EndCounts, ABeamOfNoLengthEndsWhereItBegins) {
  EndCounts counts(1.0);
  counts.add({0.5, 0.5}, {0.5, 0.5});
  EXPECT_EQ(counts.sharpness().touched_cells, 1U);
}

TEST(EndCounts, IsSurerTheOftenerBeamsAgreeAndKnowsNothingWhereTheyDoNot) {
  EndCounts agreeing(1.0);
  double before_bits = 1.0;
  for (int i = 0; i < 20; ++i) {
    agreeing.add({0.5, 0.5}, {0.5, 0.5});
    EXPECT_LT(agreeing.sharpness().entropy_bits, before_bits);
    before_bits = agreeing.sharpness().entropy_bits;
  }
  EndCounts undecided(1.0);
  undecided.add({0.5, 0.5}, {0.5, 0.5});
  undecided.add({0.5, 0.5}, {1.5, 0.5});
  EndCounts only_the_end(1.0);
  only_the_end.add({1.5, 0.5}, {1.5, 0.5});
  EXPECT_NEAR(undecided.sharpness().entropy_bits - only_the_end.sharpness().entropy_bits, 1.0,
              1e-12);
}

/// A round room of 5 m, seen from many places with poses that are off by so much.
MapSharpness of_a_room(double position_sigma_m, double heading_sigma_rad) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  EndCounts counts(kCellM);
  for (int scan = 0; scan < 100; ++scan) {
    const Pose2 truth{2.0 * std::cos(0.2 * scan), 2.0 * std::sin(0.3 * scan), 0.1 * scan};
    const Pose2 noise{position_sigma_m * normal(random), position_sigma_m * normal(random),
                      heading_sigma_rad * normal(random)};
    const Pose2 estimate = truth * noise;
    for (int beam = 0; beam < 360; ++beam) {
      const double angle_rad = beam * std::numbers::pi / 180.0;
      const Vector2 wall_m = 5.0 * Vector2(std::cos(angle_rad), std::sin(angle_rad));
      counts.add(estimate.translation_m(), estimate * (geometry::inverse(truth) * wall_m));
    }
  }
  return counts.sharpness();
}

TEST(EndCounts, NoiseOnThePosesRaisesTheEntropyAndTheMoreTheLarger) {
  const double sharp_bits = of_a_room(0.0, 0.0).mean_entropy_bits();
  const double blurred_bits = of_a_room(0.03, 0.005).mean_entropy_bits();
  const double smeared_bits = of_a_room(0.10, 0.02).mean_entropy_bits();
  EXPECT_GT(blurred_bits, 1.05 * sharp_bits);
  EXPECT_GT(smeared_bits, 1.05 * blurred_bits);
}

TEST(EndCounts, AreTheSameWhereverTheLatticeIsEntered) {
  EndCounts here(kCellM);
  EndCounts there(kCellM);
  const Vector2 shift_m(-64.0 * kCellM * 7, 64.0 * kCellM * 3);  // whole cells
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-6.0, 6.0);
  for (int i = 0; i < 200; ++i) {
    const Vector2 origin_m(place(random), place(random));
    const Vector2 end_m(place(random), place(random));
    here.add(origin_m, end_m);
    there.add(origin_m + shift_m, end_m + shift_m);
  }
  EXPECT_NEAR(static_cast<double>(here.sharpness().touched_cells),
              static_cast<double>(there.sharpness().touched_cells), 2.0);  // by rounding
  EXPECT_NEAR(here.sharpness().mean_entropy_bits(), there.sharpness().mean_entropy_bits(), 1e-3);
}

}  // namespace
}  // namespace slammot::metrics
