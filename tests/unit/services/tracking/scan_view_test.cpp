#include "services/tracking/scan_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/turned_scan.hpp"

namespace slammot::tracking {
namespace {

/// Of ten beams, the first five of which met a body 10 m away, and the rest something so far away
/// that is held to be this.
Edge edge_beside(float range_m, flow::PointLabel label) {
  flow::SegmentedScan scan = testing::turned_scan(10, 0.5 * std::numbers::pi / 180);
  scan.segments.resize(2);
  for (std::uint16_t beam = 0; beam < 10; ++beam) {
    scan.segments[beam < 5 ? 0 : 1].beams.push_back(beam);
    if (beam >= 5) scan.range_m[beam] = range_m;
  }
  scan.segments[0].label = flow::PointLabel::kMoving;
  scan.segments[1].label = label;
  return edge_beyond(ScanView(scan), 4, +1, 1.0);
}

TEST(ScanView, SeesBothHalvesOfWhatLiesAcrossTheSeam) {
  flow::SegmentedScan scan = testing::turned_scan(720, std::numbers::pi / 360);
  scan.odom_from_base = {};
  Footprint car;
  car.length.value_m = 4.5;
  car.width.value_m = 1.8;
  const auto beams_at = [&](double angle_rad) {
    car.heading_rad = angle_rad + 0.5 * std::numbers::pi;
    return ScanView(scan)
        .visibility_of(car, {8.0 * std::cos(angle_rad), 8.0 * std::sin(angle_rad)})
        .beams;
  };
  EXPECT_EQ(beams_at(-1.3), beams_at(0.0));  // where its first beam points, and elsewhere
}

TEST(ScanView, SeesNothingOfWhatIsNowhere) {
  const flow::SegmentedScan scan = testing::turned_scan(720, std::numbers::pi / 360);
  const double nowhere = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(ScanView(scan).visibility_of(Footprint(), {nowhere, nowhere}).beams, 0);
}

TEST(EdgeBeyond, IsHiddenBySomethingNearer) {
  EXPECT_EQ(edge_beside(8.0F, flow::PointLabel::kStationary), Edge::kHidden);
  EXPECT_EQ(edge_beside(8.0F, flow::PointLabel::kMoving), Edge::kHidden);
}

TEST(EdgeBeyond, IsOpenBeforeSomethingFarther) {
  EXPECT_EQ(edge_beside(15.0F, flow::PointLabel::kStationary), Edge::kOpen);
  EXPECT_EQ(edge_beside(15.0F, flow::PointLabel::kMoving), Edge::kOpen);
}

TEST(EdgeBeyond, IsHiddenWhereTheBodyMayGoOnAsAnotherSegment) {
  EXPECT_EQ(edge_beside(10.1F, flow::PointLabel::kMoving), Edge::kHidden);
  EXPECT_EQ(edge_beside(10.1F, flow::PointLabel::kUnknown), Edge::kHidden);
  EXPECT_EQ(edge_beside(10.1F, flow::PointLabel::kStationary), Edge::kOpen)
      << "a wall is no part of it";
}

TEST(EdgeBeyond, IsUnknownWithoutAnEchoAndHiddenAtTheEndOfTheView) {
  EXPECT_EQ(edge_beside(0.0F, flow::PointLabel::kUnknown), Edge::kNoEcho);
  EXPECT_EQ(edge_beyond(ScanView(testing::turned_scan(5, 0.01)), 4, +1, 1.0), Edge::kHidden);
}

}  // namespace
}  // namespace slammot::tracking
