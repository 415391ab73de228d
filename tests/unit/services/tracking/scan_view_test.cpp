#include "services/tracking/scan_view.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;

/// Of a scanner turned in odom, whose first beam does not point along an axis.
flow::SegmentedScan scan_of(std::size_t beams, double beam_step_rad) {
  flow::SegmentedScan scan;
  scan.beam_step_rad = beam_step_rad;
  scan.odom_from_base.pose = {3.0, -2.0, 2.5};
  for (std::size_t beam = 0; beam < beams; ++beam) {
    const double angle_rad = -1.3 + static_cast<double>(beam) * beam_step_rad;
    scan.range_m.push_back(10.0F);
    scan.points_in_base_m.push_back(10.0F * Eigen::Vector2f(static_cast<float>(std::cos(angle_rad)), static_cast<float>(std::sin(angle_rad))));
  }
  return scan;
}

long exact_beam_towards(const PolarView& view, const Vector2d& way) { return std::lround(view.steps_towards(std::atan2(way.y(), way.x()))); }

TEST(PolarView, KnowsTheBeamNearestToADirectionAsTheArctangentDoes) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-30.0, 30.0);
  for (const auto& [beams, step_rad] : {std::pair(361, std::numbers::pi / 360), std::pair(1081, 0.25 * std::numbers::pi / 180), std::pair(720, -std::numbers::pi / 360)}) {
    const PolarView view(scan_of(static_cast<std::size_t>(beams), step_rad));
    for (int i = 0; i < 200'000; ++i) {
      const Vector2d way(place(random), place(random));
      ASSERT_EQ(view.beam_towards(way), exact_beam_towards(view, way)) << way.transpose();
    }
  }
}

TEST(PolarView, KnowsTheNearestBeamHalfWayBetweenTwoAndBehindTheScanner) {
  const PolarView view(scan_of(361, std::numbers::pi / 360));
  const double first_rad = std::atan2(view.point_in_odom_m(0).y() - view.laser_in_odom_m().y(), view.point_in_odom_m(0).x() - view.laser_in_odom_m().x());
  for (int half_steps = -720; half_steps <= 1440; ++half_steps) {
    for (const double off_rad : {-1e-4, -1e-9, 0.0, 1e-9, 1e-4}) {
      const double angle_rad = first_rad + half_steps * std::numbers::pi / 720 + off_rad;
      const Vector2d way(5.0 * std::cos(angle_rad), 5.0 * std::sin(angle_rad));
      ASSERT_EQ(view.beam_towards(way), exact_beam_towards(view, way)) << half_steps << " " << off_rad;
    }
  }
  EXPECT_EQ(view.beam_towards({1.0, 0.0}), exact_beam_towards(view, {1.0, 0.0}));
  EXPECT_EQ(view.beam_towards({-1.0, 0.0}), exact_beam_towards(view, {-1.0, 0.0}));
  EXPECT_EQ(view.beam_towards({0.0, -1.0}), exact_beam_towards(view, {0.0, -1.0}));
}

}  // namespace
}  // namespace slammot::tracking
