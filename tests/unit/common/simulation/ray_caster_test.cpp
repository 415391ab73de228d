#include "common/simulation/ray_caster.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "common/simulation/random.hpp"

namespace slammot::simulation {
namespace {

using geometry::Vector2;

/// Tests every surface; what the grid must agree with.
double brute_force_m(const Outline& outline, const Vector2& origin, const Vector2& direction,
                     double max_range_m) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Segment& segment : outline.segments) {
    nearest = std::min(nearest, distance_along_ray(segment, origin, direction));
  }
  for (const Circle& circle : outline.circles) {
    nearest = std::min(nearest, distance_along_ray(circle, origin, direction));
  }
  return nearest <= max_range_m ? nearest : std::numeric_limits<double>::infinity();
}

Outline random_outline(Random& random) {
  Outline outline;
  for (int i = 0; i < 150; ++i) {
    const Vector2 a{random.uniform(-60.0, 60.0), random.uniform(-60.0, 60.0)};
    outline.segments.push_back(
        {a, a + Vector2{random.uniform(-12.0, 12.0), random.uniform(-12.0, 12.0)}, Material::wall});
    outline.circles.push_back(
        {{random.uniform(-60.0, 60.0), random.uniform(-60.0, 60.0)}, random.uniform(0.05, 1.5)});
  }
  return outline;
}

TEST(RayCaster, AgreesWithTestingEverySurface) {
  Random random(11, Purpose::world);
  const Outline outline = random_outline(random);
  const RayCaster caster(outline);
  for (int i = 0; i < 20000; ++i) {
    // Also from outside the world, and along the axes, where a grid walk divides by zero.
    const Vector2 origin{random.uniform(-90.0, 90.0), random.uniform(-90.0, 90.0)};
    const double heading_rad = i % 10 == 0 ? 0.5 * std::numbers::pi * (i / 10 % 4)
                                           : random.uniform(-std::numbers::pi, std::numbers::pi);
    const Vector2 direction =
        i % 10 == 0 ? Vector2{std::round(std::cos(heading_rad)), std::round(std::sin(heading_rad))}
                    : Vector2{std::cos(heading_rad), std::sin(heading_rad)};
    EXPECT_EQ(caster.cast(origin, direction, 80.0).range_m,
              brute_force_m(outline, origin, direction, 80.0));
  }
}

TEST(RayCaster, GivesTheSameRangesWhereverTheWorldLies) {
  Random random(12, Purpose::world);
  const Outline outline = random_outline(random);
  const Vector2 shift{1234.5, -987.25};
  Outline moved = outline;
  for (Segment& segment : moved.segments) segment.a += shift, segment.b += shift;
  for (Circle& circle : moved.circles) circle.centre += shift;
  const RayCaster here(outline);
  const RayCaster there(moved);
  for (int i = 0; i < 2000; ++i) {
    const Vector2 origin{random.uniform(-60.0, 60.0), random.uniform(-60.0, 60.0)};
    const double heading_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
    const Vector2 direction{std::cos(heading_rad), std::sin(heading_rad)};
    const double range_m = here.cast(origin, direction, 80.0).range_m;
    const double moved_range_m = there.cast(origin + shift, direction, 80.0).range_m;
    if (std::isinf(range_m) || std::isinf(moved_range_m))
      continue;  // rounding may decide at an end point
    EXPECT_NEAR(moved_range_m, range_m, 1e-6);
  }
}

TEST(RayCaster, SaysWhatTheSurfaceIsMadeOf) {
  Outline outline;
  outline.segments.push_back({{5.0, -1.0}, {5.0, 1.0}, Material::parked_car});
  outline.circles.push_back({{3.0, 5.0}, 0.2, Material::foliage});
  const RayCaster caster(outline);
  EXPECT_EQ(caster.cast({0.0, 0.0}, {1.0, 0.0}, 80.0).material, Material::parked_car);
  EXPECT_EQ(caster.cast({3.0, 0.0}, {0.0, 1.0}, 80.0).material, Material::foliage);
}

TEST(RayCaster, MissesEverythingInAnEmptyWorld) {
  EXPECT_TRUE(std::isinf(RayCaster(Outline{}).cast({0.0, 0.0}, {1.0, 0.0}, 80.0).range_m));
}

}  // namespace
}  // namespace slammot::simulation
