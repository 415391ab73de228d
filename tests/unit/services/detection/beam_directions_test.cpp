#include "services/detection/beam_directions.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace slammot::detection {
namespace {

constexpr double kStepRad = 0.02;

/// A scanner with an offset and a rotation; the first beams have no echo.
flow::LocalizedScan scan_of(double step_rad, std::size_t beams_without_echo) {
  flow::LocalizedScan scan;
  scan.base_from_laser = {2.0, -1.0, 0.3};
  scan.beam_step_rad = step_rad;
  scan.beams.resize(50);
  for (std::size_t i = beams_without_echo; i < scan.beams.size(); ++i) {
    const double angle_rad = -0.5 + static_cast<double>(i) * step_rad;
    const double range_m = 1.0 + 0.1 * static_cast<double>(i);
    scan.beams[i].range_m = static_cast<float>(range_m);
    scan.beams[i].point_in_base_m =
        (scan.base_from_laser *
         geometry::Vector2(range_m * std::cos(angle_rad), range_m * std::sin(angle_rad)))
            .cast<float>();
  }
  return scan;
}

void expect_directions(const flow::LocalizedScan& scan) {
  BeamDirections directions;
  directions.compute(scan);
  for (std::size_t i = 0; i < scan.beams.size(); ++i) {
    const double in_base_rad =
        scan.base_from_laser.heading_rad - 0.5 + static_cast<double>(i) * scan.beam_step_rad;
    EXPECT_LT(
        (directions[i] - geometry::Vector2(std::cos(in_base_rad), std::sin(in_base_rad))).norm(),
        1e-5)
        << i;
  }
}

TEST(BeamDirections, IncludeTheMountingOfTheScanner) { expect_directions(scan_of(kStepRad, 0)); }

TEST(BeamDirections, StartFromTheFirstEcho) { expect_directions(scan_of(kStepRad, 7)); }

TEST(BeamDirections, FollowTheScannersSenseOfRotation) { expect_directions(scan_of(-kStepRad, 7)); }

TEST(BeamDirections, AreOfTheLastScanOnly) {
  BeamDirections directions;
  directions.compute(scan_of(kStepRad, 0));
  flow::LocalizedScan other = scan_of(-kStepRad, 0);
  directions.compute(other);
  EXPECT_NEAR(directions[0].y(), std::sin(-0.2), 1e-5);
  EXPECT_NEAR(directions[10].y(), std::sin(-0.2 - 10 * kStepRad), 1e-5);
}

TEST(BeamDirections, AreAStepApartWithoutEchoes) {
  BeamDirections directions;
  directions.compute(scan_of(kStepRad, 50));
  EXPECT_NEAR(directions[0].dot(directions[1]), std::cos(kStepRad), 1e-9);
}

}  // namespace
}  // namespace slammot::detection
