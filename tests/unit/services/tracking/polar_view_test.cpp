#include "services/tracking/polar_view.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/turned_scan.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;

long exact_beam_towards(const PolarView& view, const Vector2d& way) {
  return std::lround(view.steps_towards(std::atan2(way.y(), way.x())));
}

/// Things at all ranges, some oblique, between directions without echo.
flow::SegmentedScan scan_of_things(std::mt19937& random) {
  constexpr std::size_t kBeams = 361;
  std::uniform_int_distribution<std::size_t> width(1, 25);
  std::uniform_real_distribution<float> range_m(0.5F, 40.0F);
  std::uniform_real_distribution<float> slope_m(-0.8F, 0.8F);
  std::bernoulli_distribution is_there(0.8);
  flow::SegmentedScan scan = testing::turned_scan(kBeams, std::numbers::pi / 360);
  for (std::size_t beam = 0; beam < kBeams;) {
    const std::size_t end = std::min(kBeams, beam + width(random));
    float at_m = is_there(random) ? range_m(random) : 0.0F;
    const float step_m = at_m > 0.0F ? slope_m(random) : 0.0F;
    for (; beam < end; ++beam, at_m = std::max(0.0F, at_m + step_m)) {
      scan.points_in_base_m[beam] *= at_m / scan.range_m[beam];
      scan.range_m[beam] = at_m;
    }
  }
  return scan;
}

TEST(PolarView, KnowsTheBeamNearestToADirectionAsTheArctangentDoes) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-30.0, 30.0);
  for (const auto& [beams, step_rad] :
       {std::pair(361, std::numbers::pi / 360), std::pair(1081, 0.25 * std::numbers::pi / 180),
        std::pair(720, -std::numbers::pi / 360)}) {
    const PolarView view(testing::turned_scan(static_cast<std::size_t>(beams), step_rad));
    for (int i = 0; i < 200'000; ++i) {
      const Vector2d way(place(random), place(random));
      ASSERT_EQ(view.beam_towards(way), exact_beam_towards(view, way)) << way.transpose();
    }
  }
}

TEST(PolarView, KnowsTheNearestBeamHalfWayBetweenTwoAndBehindTheScanner) {
  const PolarView view(testing::turned_scan(361, std::numbers::pi / 360));
  const double first_rad = std::atan2(view.point_in_odom_m(0).y() - view.laser_in_odom_m().y(),
                                      view.point_in_odom_m(0).x() - view.laser_in_odom_m().x());
  for (int half_steps = -720; half_steps <= 1440; ++half_steps) {
    for (const double off_rad : {-1e-4, -1e-9, 0.0, 1e-9, 1e-4}) {
      const double angle_rad = first_rad + half_steps * std::numbers::pi / 720 + off_rad;
      const Vector2d way(5.0 * std::cos(angle_rad), 5.0 * std::sin(angle_rad));
      ASSERT_EQ(view.beam_towards(way), exact_beam_towards(view, way))
          << half_steps << " " << off_rad;
    }
  }
  EXPECT_EQ(view.beam_towards({1.0, 0.0}), exact_beam_towards(view, {1.0, 0.0}));
  EXPECT_EQ(view.beam_towards({-1.0, 0.0}), exact_beam_towards(view, {-1.0, 0.0}));
  EXPECT_EQ(view.beam_towards({0.0, -1.0}), exact_beam_towards(view, {0.0, -1.0}));
}

TEST(PolarView, KnowsWhenTheBeamTowardsAPlaceIsFired) {
  flow::SegmentedScan scan = testing::turned_scan(361, std::numbers::pi / 360);
  scan.sweep_s = 0.036;
  const PolarView view(scan);
  EXPECT_DOUBLE_EQ(view.delay_s(360), 0.036);
  EXPECT_DOUBLE_EQ(view.delay_towards_s(view.point_in_odom_m(180)), 0.018);
  EXPECT_DOUBLE_EQ(view.delay_towards_s(view.point_in_odom_m(90)), 0.009);
  const Vector2d beside_the_last = 2.0 * view.laser_in_odom_m() - view.point_in_odom_m(10);
  EXPECT_DOUBLE_EQ(view.delay_towards_s(beside_the_last), 0.036);  // out of view: as near to it as
                                                                   // beams come
}

TEST(PolarView, CountsOnAcrossTheSeamOfAFullTurnOnly) {
  const PolarView round(testing::turned_scan(720, std::numbers::pi / 360));
  EXPECT_EQ(round.neighbour_of(719, 2), 1U);
  EXPECT_EQ(round.neighbour_of(0, -1), 719U);
  EXPECT_EQ(round.steps_between(718, 3), 5U);
  const PolarView half(testing::turned_scan(361, std::numbers::pi / 360));
  EXPECT_EQ(half.neighbour_of(360, 1), std::nullopt);
  EXPECT_EQ(half.neighbour_of(0, -1), std::nullopt);
  EXPECT_EQ(half.steps_between(3, 5), 2U);
  EXPECT_EQ(half.steps_between(5, 3), 361U);
  EXPECT_FALSE(PolarView(testing::turned_scan(0, 7.0)).goes_all_round())
      << "no beams, however far apart they are said to be";
}

TEST(PolarView, SeesTheSameWithDepthsMeasured) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> off_m(-40.0, 40.0);
  std::normal_distribution<double> little_m(0.0, 0.4);
  for (int i = 0; i < 50; ++i) {
    const PolarView plain(scan_of_things(random));
    PolarView measured = plain;
    measured.measure_depths();
    const auto expect_same = [&](const Vector2d& place_m) {
      ASSERT_EQ(measured.sight_of(place_m).sight, plain.sight_of(place_m).sight)
          << place_m.transpose();
      ASSERT_EQ(measured.sight_of(place_m).beam, plain.sight_of(place_m).beam)
          << place_m.transpose();
    };
    for (int j = 0; j < 5000; ++j)
      expect_same(plain.laser_in_odom_m() + Vector2d(off_m(random), off_m(random)));
    for (std::size_t beam = 0; beam < plain.beam_count(); ++beam)
      expect_same(plain.point_in_odom_m(beam) + Vector2d(little_m(random), little_m(random)));
  }
}

}  // namespace
}  // namespace slammot::tracking
