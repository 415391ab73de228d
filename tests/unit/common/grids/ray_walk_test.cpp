#include "common/grids/ray_walk.hpp"

#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/common/grids/slow_ray.hpp"

namespace slammot::grids {
namespace {

constexpr double kCell_m = 0.2;
constexpr double kGraze_m = 1e-9;  // a passage shorter than this may or may not be walked

struct Ray2 {
  Eigen::Vector2d origin_m;
  Eigen::Vector2d direction;
};

std::vector<Ray2> random_rays() {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-5.0, 5.0);
  std::uniform_real_distribution<double> angle(-std::numbers::pi, std::numbers::pi);
  std::vector<Ray2> rays;
  for (int i = 0; i < 300; ++i) {
    const double angle_rad = angle(random);
    rays.push_back({{place(random), place(random)}, {std::cos(angle_rad), std::sin(angle_rad)}});
  }
  for (const Eigen::Vector2d& along : {Eigen::Vector2d(1, 0), {-1, 0}, {0, 1}, {0, -1}})
    rays.push_back({{0.33, -0.71}, along});
  return rays;
}

struct Step {
  Cell cell;
  double entered_m;
};

std::vector<Step> walked(const Ray2& ray, double length_m) {
  std::vector<Step> steps;
  for (RayWalk walk(ray.origin_m, ray.direction, kCell_m); walk.distance_m() < length_m;
       walk.advance()) {
    steps.push_back({walk.cell(), walk.distance_m()});
  }
  return steps;
}

TEST(RayWalk, BeginsWhereTheRayBegins) {
  for (const Ray2& ray : random_rays()) {
    const RayWalk walk(ray.origin_m, ray.direction, kCell_m);
    EXPECT_EQ(walk.cell(),
              (GridWindow{.cell_size_m = kCell_m}.cell_at(ray.origin_m.x(), ray.origin_m.y())));
    EXPECT_EQ(walk.distance_m(), 0.0);
  }
}

TEST(RayWalk, MovesToANeighbourByOneSideAtEveryStep) {
  for (const Ray2& ray : random_rays()) {
    const auto steps = walked(ray, 10.0);
    for (std::size_t i = 1; i < steps.size(); ++i) {
      ASSERT_EQ(std::abs(steps[i].cell.column - steps[i - 1].cell.column) +
                    std::abs(steps[i].cell.row - steps[i - 1].cell.row),
                1);
      ASSERT_GE(steps[i].entered_m, steps[i - 1].entered_m);
    }
  }
}

TEST(RayWalk, EntersEachCellWhereTheRayDoes) {
  for (const Ray2& ray : random_rays()) {
    for (const Step& step : walked(ray, 10.0)) {
      const auto passage = passage_through(step.cell, kCell_m, ray.origin_m, ray.direction);
      if (!passage) continue;  // grazed at a corner
      EXPECT_NEAR(step.entered_m, passage->in_m, kGraze_m);
    }
  }
}

TEST(RayWalk, MissesNoCellThatTheRayPasses) {
  for (const Ray2& ray : random_rays()) {
    constexpr double kLength_m = 4.0;
    std::size_t passed = 0;
    std::size_t found = 0;
    const auto steps = walked(ray, kLength_m);
    const GridWindow around = window_around(ray.origin_m, 2.0 * kLength_m + 1.0, kCell_m);
    for (std::int32_t row = 0; row < around.rows; ++row) {
      for (std::int32_t column = 0; column < around.columns; ++column) {
        const Cell cell{around.first.column + column, around.first.row + row};
        const auto passage = passage_through(cell, kCell_m, ray.origin_m, ray.direction);
        if (!passage || passage->in_m > kLength_m - kGraze_m || passage->length_m() < kGraze_m)
          continue;
        ++passed;
        found += std::count_if(steps.begin(), steps.end(),
                               [&](const Step& step) { return step.cell == cell; });
      }
    }
    ASSERT_GT(passed, 10U);
    ASSERT_EQ(found, passed);
  }
}

}  // namespace
}  // namespace slammot::grids
