#include "services/tracking/axis_measurement.hpp"

#include <gtest/gtest.h>

namespace slammot::tracking {
namespace {

const Size kCarLength{4.4, 0.16};

/// A flank of this visible span, seen by a laser at this coordinate.
Projection flank(double low_m, double high_m, Edge low, Edge high) {
  Projection projection;
  projection.low_m = low_m;
  projection.high_m = high_m;
  projection.low_edge = low;
  projection.high_edge = high;
  projection.count = 10;
  projection.face_m = low_m;
  projection.face_count = 1;
  return projection;
}

AxisView view_from(double laser_at_m) {
  AxisView view;
  view.laser_at_m = laser_at_m;
  view.face_variance_m2 = 0.0009;
  view.low = view.high = {0.1, 0.0};
  return view;
}

TEST(AxisMeasurement, IsMirroredWithItsAxis) {
  const Projection projection = flank(-2.0, 1.0, Edge::kOpen, Edge::kHidden);
  for (const double laser_at_m : {-8.0, 0.3, 8.0}) {
    const AxisMeasurement here = measure_axis(kCarLength, projection, view_from(laser_at_m), true);
    const AxisMeasurement there =
        measure_axis(kCarLength, mirrored(projection), mirrored(view_from(laser_at_m)), true);
    EXPECT_NEAR(here.centre_m, -there.centre_m, 1e-12) << laser_at_m;
    EXPECT_NEAR(here.variance_m2, there.variance_m2, 1e-12) << laser_at_m;
    EXPECT_EQ(here.anchor.value_or(9), there.anchor ? -*there.anchor : 9) << laser_at_m;
  }
}

TEST(AxisMeasurement, IsAnchoredAtTheEndThatIsVisible) {
  const AxisMeasurement low =
      measure_axis(kCarLength, flank(-2.1, 0.0, Edge::kOpen, Edge::kHidden), view_from(0.0), true);
  EXPECT_EQ(low.anchor, -1);
  EXPECT_NEAR(low.centre_m, -2.1 - 0.05 + 2.2, 1e-9);
  const AxisMeasurement both =
      measure_axis(kCarLength, flank(-2.15, 2.15, Edge::kOpen, Edge::kOpen), view_from(0.0), true);
  EXPECT_EQ(both.anchor, 0);
  EXPECT_NEAR(both.centre_m, 0.0, 1e-9);
  EXPECT_LT(both.variance_m2, low.variance_m2);
}

TEST(AxisMeasurement, IsUnknownBetweenTwoOccluders) {
  const AxisMeasurement hidden = measure_axis(
      kCarLength, flank(-1.0, 1.0, Edge::kHidden, Edge::kHidden), view_from(0.0), true);
  EXPECT_FALSE(hidden.anchor.has_value());
  EXPECT_GT(hidden.variance_m2, 1.0);
}

TEST(AxisMeasurement, SaysHowLongAFlankIsThatIsVisibleFromEndToEnd) {
  SizeEvidence evidence;
  add_sizes(evidence, kCarLength, flank(-2.1, 2.1, Edge::kOpen, Edge::kOpen), view_from(0.0), true);
  EXPECT_NEAR(evidence.whole.value_m, 4.3, 1e-3);  // half a spacing beyond each end
  EXPECT_EQ(evidence.least_m, 4.2);
  SizeEvidence cut_off;
  add_sizes(cut_off, kCarLength, flank(-2.1, 2.1, Edge::kHidden, Edge::kOpen), view_from(0.0),
            true);
  EXPECT_EQ(cut_off.whole.variance_m2, kUnknownSizeM2);
}

TEST(AxisMeasurement, SaysHowWideABodyIsOfWhichTheNextBeamsPassBeside) {
  const auto width_seen = [](Edge high, double laser_at_m) {
    Projection one = flank(0.0, 0.0, Edge::kOpen, high);
    one.count = 1;
    SizeEvidence evidence;
    add_sizes(evidence, {2.35, 0.04}, one, view_from(laser_at_m), true);
    return evidence.whole;
  };
  for (const double laser_at_m : {0.0, -3.0}) {
    EXPECT_NEAR(width_seen(Edge::kOpen, laser_at_m).value_m, 0.1, 1e-3) << laser_at_m;  // a spacing
    EXPECT_EQ(width_seen(Edge::kNoEcho, laser_at_m).variance_m2, kUnknownSizeM2) << laser_at_m;
    EXPECT_EQ(width_seen(Edge::kHidden, laser_at_m).variance_m2, kUnknownSizeM2) << laser_at_m;
  }
}

TEST(AxisMeasurement, MakesAStepWhenItsAnchorChanges) {
  EXPECT_EQ(step_variance_m2(1, 1, kCarLength), 0.0);
  EXPECT_EQ(step_variance_m2(std::nullopt, 1, kCarLength), 0.0);
  EXPECT_DOUBLE_EQ(step_variance_m2(-1, 1, kCarLength), kCarLength.variance_m2);
  EXPECT_DOUBLE_EQ(step_variance_m2(0, 1, kCarLength), 0.25 * kCarLength.variance_m2);
}

}  // namespace
}  // namespace slammot::tracking
