#include "common/simulation/terrain.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace slammot::simulation {
namespace {

using geometry::Vector2;

const Terrain kHill({{10.0, 0.0}, {30.0, 2.0}, {50.0, 2.0}, {70.0, 0.0}});

TEST(Terrain, IsLevelBeforeAndAfterAndStraightBetween) {
  EXPECT_EQ(kHill.height_m(-5.0), 0.0);
  EXPECT_NEAR(kHill.height_m(20.0), 1.0, 1e-12);
  EXPECT_EQ(kHill.height_m(40.0), 2.0);
  EXPECT_EQ(kHill.height_m(100.0), 0.0);
  EXPECT_EQ(Terrain().height_m(20.0), 0.0);
}

TEST(Terrain, TipsABodyByItsSlopeAndHeading) {
  const double slope_rad = std::atan(0.1);
  EXPECT_NEAR(kHill.nose_down_rad({20.0, 3.0, 0.0}), -slope_rad, 1e-9);
  EXPECT_NEAR(kHill.nose_down_rad({20.0, 3.0, M_PI}), slope_rad, 1e-9);
  EXPECT_NEAR(kHill.nose_down_rad({20.0, 3.0, M_PI_2}), 0.0, 1e-9);
  EXPECT_NEAR(kHill.nose_down_rad({40.0, 3.0, 0.0}), 0.0, 1e-9);
}

TEST(Terrain, IsMetByALevelRayWhereItRises) {
  EXPECT_NEAR(kHill.distance_to_ground({0.0, 0.0}, {1.0, 0.0}, 0.6, 0.0), 16.0, 1e-9);
  EXPECT_TRUE(std::isinf(kHill.distance_to_ground({0.0, 0.0}, {-1.0, 0.0}, 0.6, 0.0)));
  EXPECT_TRUE(std::isinf(kHill.distance_to_ground({0.0, 0.0}, {0.0, 1.0}, 0.6, 0.0)));
}

TEST(Terrain, AgreesWithSmallStepsAlongTheRay) {
  const Vector2 direction{std::cos(0.3), std::sin(0.3)};
  for (const double rise : {-0.05, -0.02, 0.01, 0.03, 0.09}) {
    for (const double x_m : {-20.0, 5.0, 25.0, 45.0, 60.0}) {
      const double z_m = kHill.height_m(x_m) + 0.6;
      double stepped_m = 0.0;
      while (stepped_m < 200.0 &&
             z_m + rise * stepped_m > kHill.height_m(x_m + stepped_m * direction.x()))
        stepped_m += 0.01;
      const double range_m = kHill.distance_to_ground({x_m, 0.0}, direction, z_m, rise);
      if (stepped_m >= 200.0) {
        EXPECT_GT(range_m, 199.0) << x_m << " " << rise;
      } else {
        EXPECT_NEAR(range_m, stepped_m, 0.011) << x_m << " " << rise;
      }
    }
  }
}

}  // namespace
}  // namespace slammot::simulation
