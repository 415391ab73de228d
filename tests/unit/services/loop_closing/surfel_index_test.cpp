#include "services/loop_closing/surfel_index.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace slammot::loop_closing {
namespace {

std::vector<flow::Surfel> random_surfels(int count) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<float> place(-10.0F, 10.0F);
  std::uniform_real_distribution<float> angle(0.0F, 6.28F);
  std::vector<flow::Surfel> surfels;
  for (int i = 0; i < count; ++i) {
    const float direction = angle(random);
    const bool has_normal = i % 4 != 0;
    surfels.push_back({place(random), place(random), has_normal ? std::cos(direction) : 0.0F,
                       has_normal ? std::sin(direction) : 0.0F, 1.0F});
  }
  return surfels;
}

float distance_by_brute_force(const std::vector<flow::Surfel>& surfels, const Eigen::Vector2f& at,
                              const Eigen::Vector2f& normal, float reach_m) {
  float best = reach_m;
  for (const flow::Surfel& surfel : surfels) {
    const Eigen::Vector2f other(surfel.normal_x, surfel.normal_y);
    if (!other.isZero() && !normal.isZero() && std::abs(other.dot(normal)) < 0.7F) continue;
    best = std::min(best, (Eigen::Vector2f(surfel.x_m, surfel.y_m) - at).norm());
  }
  return best;
}

TEST(SurfelIndex, AgreesWithBruteForce) {
  const auto surfels = random_surfels(800);
  const SurfelIndex index(surfels, 1.0);
  std::mt19937_64 random(6);
  std::uniform_real_distribution<float> place(-12.0F, 12.0F);
  std::uniform_real_distribution<float> angle(0.0F, 6.28F);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector2f at(place(random), place(random));
    const float direction = angle(random);
    const Eigen::Vector2f normal = i % 3 == 0
                                       ? Eigen::Vector2f(0.0F, 0.0F)
                                       : Eigen::Vector2f(std::cos(direction), std::sin(direction));
    const float reach_m = i % 2 == 0 ? 1.0F : 0.3F;
    const flow::Surfel* found = index.nearest(at, normal, reach_m);
    const float expected_m = distance_by_brute_force(surfels, at, normal, reach_m);
    ASSERT_EQ(found != nullptr, expected_m < reach_m);
    if (found != nullptr)
      ASSERT_NEAR((Eigen::Vector2f(found->x_m, found->y_m) - at).norm(), expected_m, 1e-5F);
  }
}

TEST(SurfelIndex, FindsNothingInAnEmptyIndex) {
  EXPECT_EQ(SurfelIndex({}, 1.0).nearest({0.0F, 0.0F}, {1.0F, 0.0F}, 1.0F), nullptr);
}

}  // namespace
}  // namespace slammot::loop_closing
