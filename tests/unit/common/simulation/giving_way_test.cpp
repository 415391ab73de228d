#include "common/simulation/giving_way.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace slammot::simulation {
namespace {

using geometry::Vector2;

constexpr double kStep_s = 0.02;

Disc walker(const Vector2& centre, const Vector2& velocity_mps) {
  return {centre, velocity_mps, kPedestrianRadius_m, true};
}

struct Walk {
  Disc disc;
  Vector2 preferred_mps;
};

/// Walks for a duration; the least distance of two centres.
double least_distance_m(std::vector<Walk>& walks, const Outline& stationary, double duration_s) {
  double least_m = 1e9;
  for (double time_s = 0.0; time_s < duration_s; time_s += kStep_s) {
    std::vector<Vector2> velocities_mps;
    for (std::size_t i = 0; i < walks.size(); ++i) {
      std::vector<Disc> others;
      for (std::size_t j = 0; j < walks.size(); ++j) {
        if (j != i) others.push_back(walks[j].disc);
      }
      velocities_mps.push_back(
          velocity_giving_way(walks[i].disc, walks[i].preferred_mps, others, stationary, kStep_s));
    }
    for (std::size_t i = 0; i < walks.size(); ++i) {
      walks[i].disc.velocity_in_world_mps = velocities_mps[i];
      walks[i].disc.centre_in_world += velocities_mps[i] * kStep_s;
      for (std::size_t j = 0; j < i; ++j)
        least_m = std::min(least_m,
                           (walks[i].disc.centre_in_world - walks[j].disc.centre_in_world).norm());
    }
  }
  return least_m;
}

TEST(GivingWay, KeepsExactlyThePreferredVelocityWhereNobodyIsInTheWay) {
  const Vector2 preferred_mps{1.234, 0.1};
  const std::vector<Disc> others = {walker({-1.0, 0.0}, {-1.0, 0.0}),
                                    walker({20.0, 0.0}, {-1.0, 0.0})};
  Outline wall;
  wall.segments.push_back({{-10.0, 1.0}, {10.0, 1.0}, Material::wall});
  EXPECT_EQ(
      velocity_giving_way(walker({0.0, 0.0}, preferred_mps), preferred_mps, others, wall, kStep_s),
      preferred_mps);
}

TEST(GivingWay, LetsTwoWhoMeetHeadOnPassEachOtherOnTheRight) {
  std::vector<Walk> walks = {{walker({0.0, 0.0}, {1.2, 0.0}), {1.2, 0.0}},
                             {walker({8.0, 0.0}, {-1.4, 0.0}), {-1.4, 0.0}}};
  EXPECT_GT(least_distance_m(walks, {}, 7.0), 0.55);
  EXPECT_GT(walks[0].disc.centre_in_world.x(), 7.0);
  EXPECT_LT(walks[1].disc.centre_in_world.x(), 1.0);
  EXPECT_LT(walks[0].disc.centre_in_world.y(), walks[1].disc.centre_in_world.y());
}

TEST(GivingWay, GoesRoundOneWhoStandsWithoutMovingThem) {
  std::vector<Walk> walks = {
      {walker({0.0, 0.0}, {1.2, 0.0}), {1.2, 0.0}},
      {{{5.0, 0.0}, Vector2::Zero(), kPedestrianRadius_m, false}, Vector2::Zero()}};
  EXPECT_GT(least_distance_m(walks, {}, 8.0), 0.55);
  EXPECT_GT(walks[0].disc.centre_in_world.x(), 7.0);
  EXPECT_EQ(walks[1].disc.centre_in_world, Vector2(5.0, 0.0));
}

TEST(GivingWay, OvertakesInAFile) {
  std::vector<Walk> walks = {{walker({0.0, 0.0}, {1.6, 0.0}), {1.6, 0.0}},
                             {walker({2.0, 0.0}, {0.8, 0.0}), {0.8, 0.0}}};
  EXPECT_GT(least_distance_m(walks, {}, 10.0), 0.55);
  EXPECT_GT(walks[0].disc.centre_in_world.x(), walks[1].disc.centre_in_world.x());
}

TEST(GivingWay, KeepsApartInAThrongBetweenWalls) {
  Outline walls;
  walls.segments.push_back({{-50.0, 1.5}, {50.0, 1.5}, Material::wall});
  walls.segments.push_back({{50.0, -1.5}, {-50.0, -1.5}, Material::wall});
  std::vector<Walk> walks;
  for (int i = 0; i < 24; ++i) {
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    const Vector2 velocity_mps{side * (1.0 + 0.02 * i), 0.0};
    walks.push_back(
        {walker({-side * (3.0 + 0.7 * (i / 6)), -1.0 + 0.9 * (i % 6 / 2)}, velocity_mps),
         velocity_mps});
  }
  EXPECT_GT(least_distance_m(walks, walls, 15.0), 0.4);
  for (const Walk& walk : walks) EXPECT_LT(std::abs(walk.disc.centre_in_world.y()), 1.5);
}

}  // namespace
}  // namespace slammot::simulation
