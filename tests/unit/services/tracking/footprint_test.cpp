#include "services/tracking/footprint.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;

TEST(Footprint, IsLeftByTheOffsetFromItsNearestSideWhichIsZeroInside) {
  Footprint box;
  box.heading_rad = M_PI / 2.0;
  box.length.value_m = 4.0;
  box.width.value_m = 2.0;
  EXPECT_TRUE(offset_from(box, {1.0, 1.0}, 0.0, {1.5, 2.5}).isZero());
  const Vector2d outside = offset_from(box, {1.0, 1.0}, 0.0, {4.0, 1.0});
  EXPECT_NEAR(outside.x(), 2.0, 1e-9);
  EXPECT_NEAR(outside.y(), 0.0, 1e-9);
}

}  // namespace
}  // namespace slammot::tracking
