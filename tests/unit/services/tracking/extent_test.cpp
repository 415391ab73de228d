#include "services/tracking/extent.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;

const TrackingConfig kConfig;

TEST(Extent, IsABlobUntilItIsGivenABox) {
  Extent extent;
  EXPECT_NE(extent.blob(), nullptr);
  EXPECT_EQ(extent.box(), nullptr);
  extent.outline = Box();
  EXPECT_EQ(extent.blob(), nullptr);
  EXPECT_NE(extent.box(), nullptr);
}

TEST(Extent, HasTheFootprintOfWhatItIs) {
  Extent extent;
  extent.footprint().length = {0.6, 0.01};
  EXPECT_EQ(extent.blob()->length.value_m, 0.6);
  extent.outline = Box();
  extent.footprint().length = {4.5, 0.01};
  EXPECT_EQ(extent.box()->length.value_m, 4.5);
}

TEST(Extent, IsThatOfAVehicleIfItIsABoxAndNoBicycle) {
  EXPECT_FALSE(is_vehicle(Outline(Blob())));
  Box box;
  box.kind = Kind::kTruck;
  EXPECT_TRUE(is_vehicle(Outline(box)));
  box.kind = Kind::kBicycle;
  EXPECT_FALSE(is_vehicle(Outline(box)));
}

TEST(Extent, IsImplausibleAsABoxWiderThanAnyRoadUserOnly) {
  Box wide;
  wide.evidence.width.least_m = kWidestM + 0.1;
  EXPECT_FALSE(is_plausible(Outline(wide), kConfig));
  Blob large;
  large.length = large.width = {kWidestM + 0.1, 0.1};
  EXPECT_TRUE(is_plausible(Outline(large), kConfig));
}

TEST(Extent, KeepsAtMost64PointsOfItsContourAndTheLargestSpan) {
  std::vector<Vector2d> flank_m;
  for (int i = 0; i < 200; ++i) flank_m.emplace_back(8.0, 0.02 * i);
  Observation observation;
  observation.points_m = flank_m;
  Extent extent;
  store_contour(extent, observation);
  EXPECT_LE(extent.contour_in_odom_m.size(), 64U);
  EXPECT_GE(extent.contour_in_odom_m.size(), 32U);
  EXPECT_NEAR(extent.largest_span_m, 0.02 * 199, 1e-9);
  observation.points_m = std::span(flank_m).first(3);
  store_contour(extent, observation);
  EXPECT_EQ(extent.contour_in_odom_m.size(), 3U);
  EXPECT_NEAR(extent.largest_span_m, 0.02 * 199, 1e-9);
}

TEST(Extent, IsMeasuredAsWhatItIs) {
  const std::vector<Vector2d> points_m = {{10.0, -0.2}, {10.0, 0.0}, {10.0, 0.2}};
  Observation observation;
  observation.points_m = points_m;
  observation.beam_step_rad = 0.02;
  const Vector2d predicted_m{12.2, 0.0};
  EXPECT_FALSE(is_box(measure(Blob(), predicted_m, observation, kConfig).outline));
  const Outline car = with_likely_sizes(Box(), kConfig);
  const OutlineMeasurement of_car = measure(car, predicted_m, observation, kConfig);
  EXPECT_TRUE(is_box(of_car.outline));
  EXPECT_LT(measure(Blob(), predicted_m, observation, kConfig).centre_m.x(), 10.5);
  EXPECT_GT(of_car.centre_m.x(), 11.5) << "the hidden part of a car lies behind its visible face";
}

TEST(Extent, HasEchoesOffItsSidesOnBothSidesOfThem) {
  Box box;
  box.length = {4.0, 0.01};
  box.width = {2.0, 0.01};
  const std::vector<Vector2d> points_m = {{7.9, 0.0}, {8.1, 0.0}, {8.0, 0.0}};  // the rear of a box
                                                                                // at (10, 0)
  EXPECT_NEAR(distance_from_sides_m(box, {10.0, 0.0}, points_m), 0.2 / 3.0, 1e-9);
}

}  // namespace
}  // namespace slammot::tracking
