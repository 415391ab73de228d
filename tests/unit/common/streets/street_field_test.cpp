#include "common/streets/street_field.hpp"

#include <numbers>

#include <gtest/gtest.h>

namespace slammot::streets {
namespace {

using geometry::Pose2;
using geometry::Vector2;

StreetNetwork crossing() {
  return StreetNetwork(StreetGraph{
      {}, {{"east", {{-100.0, 0.0}, {100.0, 0.0}}}, {"north", {{0.0, -100.0}, {0.0, 100.0}}}}});
}

TEST(StreetField, FindsTheStreetThatRunsInTheHeadingAndNotTheNearerOne) {
  const StreetField field(crossing(), {Vector2::Zero(), 120.0});
  const auto nearest = field.nearest(Pose2{2.0, 9.0, 0.1});
  ASSERT_TRUE(nearest);
  EXPECT_NEAR(nearest->distance_m, 9.0, 1e-9);
  EXPECT_NEAR(nearest->direction_rad, 0.0, 1e-9);
}

TEST(StreetField, TurnsTheDirectionIntoTheSenseOfTheHeading) {
  const StreetField field(crossing(), {Vector2::Zero(), 120.0});
  const auto nearest = field.nearest(Pose2{1.0, 50.0, -0.5 * std::numbers::pi});
  ASSERT_TRUE(nearest);
  EXPECT_NEAR(nearest->direction_rad, -0.5 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(nearest->point_m.y(), 50.0, 1e-9);
}

TEST(StreetField, HasNoStreetBeyondItsReachOrOutsideOfItsArea) {
  const StreetField field(crossing(), {Vector2::Zero(), 120.0});
  EXPECT_FALSE(field.nearest(Pose2{50.0, 40.0, 0.0}));
  EXPECT_FALSE(field.nearest(Pose2{500.0, 0.0, 0.0}));
}

}  // namespace
}  // namespace slammot::streets
