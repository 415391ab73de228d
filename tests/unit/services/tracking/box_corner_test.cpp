#include "services/tracking/box_corner.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;

/// Depth that is measured of a corner at the origin, of a box in the first quadrant, cut off at 45
/// degrees by this length of either side.
std::optional<Size> measured_depth(double cut_m, double spacing_m) {
  std::vector<Vector2d> points_m;
  for (double s = cut_m; s < 2.0; s += 0.05) points_m.emplace_back(s, 0.0);
  for (double s = cut_m; s < 2.0; s += 0.05) points_m.emplace_back(0.0, s);
  for (double s = 0.0; s < cut_m; s += 0.05) points_m.emplace_back(s, cut_m - s);
  Observation observation;
  observation.points_m = points_m;
  AxisView view;
  view.face_variance_m2 = 1e-6;
  view.low = view.high = {spacing_m, 0.0};
  return seen_corner(observation, Vector2d::Zero(),
                     {Vector2d::UnitX(), Vector2d::UnitY(), view, view, {0.0, 1.0}, {0.0, 1.0}});
}

TEST(BoxCorner, IsAsDeepAsItIsCut) {
  for (const double cut_m : {0.0, 0.2, 0.4})
    EXPECT_NEAR(measured_depth(cut_m, 0.05)->value_m, cut_m, 0.02) << cut_m;
}

TEST(BoxCorner, IsNotMeasuredByEchoesFarApart) {
  EXPECT_FALSE(measured_depth(0.2, 0.5).has_value());
}

TEST(BoxCorner, IsFusedDownToAFloor) {
  Size corner{0.0, 1e6};
  for (int scan = 0; scan < 1000; ++scan) corner = with_corner(corner, {0.3, 0.01}, 1.0);
  EXPECT_NEAR(corner.value_m, 0.3, 1e-3);
  EXPECT_NEAR(std::sqrt(corner.variance_m2), 0.02, 1e-9);
}

TEST(NearSide, FacesTheLaserFromBeyondTheBoxOnly) {
  Projection projection;
  projection.face_m = -2.1;
  projection.face_across_m = 1.6;
  projection.face_count = 8;
  AxisView view;
  view.laser_at_m = -9.0;
  const std::optional<NearSide> side = near_side({4.4, 0.1}, projection, view);
  ASSERT_TRUE(side);
  EXPECT_EQ(side->at_m, -2.1);
  EXPECT_EQ(side->inwards, 1.0);
  view.laser_at_m = 1.0;
  EXPECT_FALSE(near_side({4.4, 0.1}, projection, view));
  view.laser_at_m = -9.0;
  projection.face_across_m = 0.2;
  EXPECT_FALSE(near_side({4.4, 0.1}, projection, view)) << "the end of a flank";
}

}  // namespace
}  // namespace slammot::tracking
