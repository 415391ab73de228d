#include "common/grids/surfel_map.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

namespace slammot::grids {
namespace {

using Eigen::Vector2d;

constexpr double kCell_m = 0.25;
constexpr double kManyEchoes = 1000.0;

SurfelMap empty_map(double side_m = 20.0, double weight_limit = kManyEchoes) {
  return {window_around({0.0, 0.0}, side_m, kCell_m), weight_limit};
}

Vector2d unit(double angle_rad) { return {std::cos(angle_rad), std::sin(angle_rad)}; }

/// A wall through a point, seen every 5 cm, with noise across it.
SurfelMap map_of_wall(const Vector2d& through_m, double angle_rad, double noise_m,
                      int passes = 10) {
  SurfelMap map = empty_map();
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0.0, noise_m);
  const Vector2d across(-std::sin(angle_rad), std::cos(angle_rad));
  for (int pass = 0; pass < passes; ++pass) {
    for (double along_m = -5.0; along_m < 5.0; along_m += 0.05) {
      map.add(through_m + (along_m + 0.005 * pass) * unit(angle_rad) + noise(random) * across);
    }
  }
  return map;
}

std::vector<Vector2d> scattered_points(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-8.0, 8.0);
  std::vector<Vector2d> points;
  for (int i = 0; i < count; ++i) points.emplace_back(place(random), place(random));
  return points;
}

TEST(SurfelMap, HoldsTheSameOfEchoesAddedTogetherAsOfEachByItself) {
  constexpr double kOdometer_m = 3.0;
  std::vector<Vector2d> points_m = scattered_points(200, 5);
  for (double along_m = -12.0; along_m < 12.0; along_m += 0.04)
    points_m.push_back({along_m, 0.3 * along_m});  // beyond the window, too
  SurfelMap together = empty_map(20.0, 4.0);
  SurfelMap one_by_one = empty_map(20.0, 4.0);
  together.add_all(points_m, kOdometer_m);
  for (const Vector2d& point_m : points_m) one_by_one.add(point_m, kOdometer_m);
  const std::vector<SurfelView> seen = together.all();
  const std::vector<SurfelView> expected = one_by_one.all();
  ASSERT_EQ(seen.size(), expected.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    EXPECT_EQ(seen[i].cell, expected[i].cell);
    EXPECT_EQ(seen[i].mean_m, expected[i].mean_m);
    EXPECT_EQ(seen[i].normal, expected[i].normal);
    EXPECT_EQ(seen[i].weight, expected[i].weight);
    EXPECT_EQ(seen[i].own_echoes, expected[i].own_echoes);
  }
}

TEST(SurfelMap, HoldsTheMeanOfTheEchoesInACell) {
  SurfelMap map = empty_map();
  map.add({0.05, 0.10});
  map.add({0.15, 0.20});
  map.add({0.10, 0.12});
  const auto surfels = map.all();
  ASSERT_EQ(surfels.size(), 1U);
  EXPECT_NEAR((surfels[0].mean_m - Vector2d(0.10, 0.14)).norm(), 0.0, 1e-7);
  EXPECT_EQ(surfels[0].weight, 3.0);
  EXPECT_EQ(surfels[0].own_echoes, 3.0);
}

TEST(SurfelMap, IgnoresWhatIsOutside) {
  SurfelMap map = empty_map(4.0);
  map.add({100.0, 0.0});
  EXPECT_TRUE(map.all().empty());
  EXPECT_FALSE(map.nearest({100.0, 0.0}, 3));
}

TEST(SurfelMap, FindsTheNearestLikeASearchThroughAll) {
  SurfelMap map = empty_map();
  for (const Vector2d& point_m : scattered_points(800, 6)) map.add(point_m);
  const auto all = map.all();
  int compared = 0;
  for (const Vector2d& point_m : scattered_points(2000, 7)) {
    const Cell centre = map.window().cell_at(point_m.x(), point_m.y());
    const auto nearest_within = [&](int radius) -> const SurfelView* {
      const SurfelView* nearest = nullptr;
      for (const SurfelView& one : all) {
        if (std::max(std::abs(one.cell.column - centre.column),
                     std::abs(one.cell.row - centre.row)) > radius)
          continue;
        if (!nearest || (one.mean_m - point_m).norm() < (nearest->mean_m - point_m).norm())
          nearest = &one;
      }
      return nearest;
    };
    const SurfelView* expected = nearest_within(1) ? nearest_within(1) : nearest_within(3);
    const auto found = map.nearest(point_m, 3);
    ASSERT_EQ(found.has_value(), expected != nullptr);
    if (!expected) continue;
    ASSERT_EQ(found->cell, expected->cell);
    ++compared;
  }
  EXPECT_GT(compared, 1000);
}

TEST(SurfelMap, KnowsTheDirectionOfAWall) {
  for (int degrees = -90; degrees < 90; degrees += 10) {
    const double angle_rad = degrees * std::numbers::pi / 180.0;
    const SurfelMap map = map_of_wall({0.13, 0.07}, angle_rad, 0.01);
    for (double along_m = -4.0; along_m < 4.0; along_m += 0.3) {
      const auto surfel = map.nearest(Vector2d(0.13, 0.07) + along_m * unit(angle_rad), 1);
      ASSERT_TRUE(surfel);
      EXPECT_NEAR(surfel->normal.norm(), 1.0, 1e-6);
      EXPECT_LT(std::abs(surfel->normal.dot(unit(angle_rad))),
                std::sin(5.0 * std::numbers::pi / 180.0))
          << degrees;
    }
  }
}

TEST(SurfelMap, KnowsTheDirectionAndTheSpreadOfAllEchoesAround) {
  // One echo a cell, so that each counts the same: held against their covariance, computed from the
  // echoes themselves.
  std::mt19937 random(5);
  std::uniform_real_distribution<double> anywhere(0.3, 0.7);
  SurfelMap map = empty_map();
  std::vector<Vector2d> echoes_m;
  for (const Cell cell : {Cell{-1, -1}, Cell{0, -1}, Cell{0, 0}, Cell{1, 0}, Cell{1, 1}}) {
    echoes_m.push_back(kCell_m *
                       Vector2d(cell.column + anywhere(random), cell.row + anywhere(random)));
  }
  map.add_all(echoes_m, 0.0);
  Vector2d mean_m = Vector2d::Zero();
  for (const Vector2d& echo_m : echoes_m) mean_m += echo_m / 5.0;
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Zero();
  for (const Vector2d& echo_m : echoes_m)
    covariance_m2 += (echo_m - mean_m) * (echo_m - mean_m).transpose() / 5.0;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(covariance_m2);
  const auto surfel = map.nearest(echoes_m[2], 1);
  ASSERT_TRUE(surfel);
  ASSERT_EQ(surfel->cell, (Cell{0, 0}));
  EXPECT_NEAR(std::abs(surfel->normal.dot(axes.eigenvectors().col(0))), 1.0, 1e-6);
  EXPECT_NEAR(surfel->spread_m2, axes.eigenvalues()(0), 1e-4 * axes.eigenvalues()(1));
}

TEST(SurfelMap, KnowsHowThickAWallLooks) {
  const double noise_m = 0.04;
  const SurfelMap map = map_of_wall({0.0, 0.125}, 0.0, noise_m, 100);
  double sum_m2 = 0.0;
  int count = 0;
  for (double along_m = -4.0; along_m < 4.0; along_m += 0.25, ++count)
    sum_m2 += map.nearest({along_m, 0.125}, 1)->spread_m2;
  // Seldom seen cells beside the wall count for more than their echoes, so a little thicker.
  EXPECT_NEAR(std::sqrt(sum_m2 / count), 1.1 * noise_m, 0.1 * noise_m);
}

TEST(SurfelMap, GivesDotsAndBlobsNoDirection) {
  SurfelMap dot = empty_map();
  for (int i = 0; i < 20; ++i) dot.add({1.0 + 0.001 * i, 1.0});
  EXPECT_TRUE(dot.all().front().normal.isZero());
  SurfelMap blob = empty_map();
  std::mt19937 random(8);
  std::uniform_real_distribution<double> place(-0.4, 0.4);
  for (int i = 0; i < 2000; ++i) blob.add({place(random), place(random)});
  EXPECT_TRUE(blob.nearest({0.0, 0.0}, 1)->normal.isZero());
}

/// Echoes every centimetre of a surface 0.2 m wide, as of a trunk, across x.
void add_trunk(SurfelMap& map, const Vector2d& middle_m) {
  for (int i = -10; i <= 10; ++i) map.add(middle_m + Vector2d(0.0, 0.01 * i));
}

TEST(SurfelMap, TellsWhereAnObjectIsThatStandsAlone) {
  for (const double y_m : {0.125, 0.25}) {  // in the middle of a cell, and across a border
    SurfelMap map = empty_map();
    add_trunk(map, {0.125, y_m});
    const auto object = map.lone_object_at(map.nearest_place({0.125, y_m + 0.09}, 1));
    ASSERT_TRUE(object);
    EXPECT_NEAR(object->mean_m.x(), 0.125, 1e-4);
    EXPECT_NEAR(object->mean_m.y(), y_m, 0.01);
    EXPECT_NEAR(object->extent_m2, 0.2 * 0.2 / 12.0, 5e-4);
  }
}

TEST(SurfelMap, TellsNoObjectNextToAnotherOne) {
  SurfelMap map = empty_map();
  add_trunk(map, {0.125, 0.125});
  add_trunk(map, {0.125, 0.625});
  EXPECT_FALSE(map.lone_object_at(map.nearest_place({0.125, 0.125}, 1)));
  add_trunk(map, {0.125, -0.625});
  EXPECT_TRUE(map.lone_object_at(map.nearest_place({0.125, -0.625}, 1)));
}

TEST(SurfelMap, TellsNoObjectInAWall) {
  const SurfelMap map = map_of_wall({0.1, 0.1}, 0.3, 0.01);
  EXPECT_FALSE(map.lone_object_at(map.nearest_place({0.1, 0.1}, 1)));
}

TEST(SurfelMap, FollowsASurfaceThatMovesOnceTheLimitIsReached) {
  SurfelMap map = empty_map(20.0, 10.0);
  for (int i = 0; i < 100; ++i) map.add({0.05, 0.1});
  for (int i = 0; i < 100; ++i) map.add({0.20, 0.1});
  const SurfelView surfel = map.all().front();
  EXPECT_NEAR(surfel.mean_m.x(), 0.20, 0.001);
  EXPECT_NEAR(surfel.weight, 10.0, 1e-3);
  EXPECT_EQ(surfel.own_echoes, 200.0);
}

TEST(SurfelMap, KnowsOverWhichPartOfTheWayASurfaceWasSeen) {
  SurfelMap map = empty_map();
  map.add({0.05, 0.05}, 3.0);
  map.add({0.05, 0.05}, 7.5);
  EXPECT_DOUBLE_EQ(map.all().front().seen_over_m, 4.5);
  map.erase({0, 0});
  map.add({0.05, 0.05}, 9.0);
  EXPECT_DOUBLE_EQ(map.all().front().seen_over_m, 0.0);
}

TEST(SurfelMap, HoldsWhatWasThereWhereTheDriveBeganForProven) {
  SurfelMap map = empty_map();
  map.add({0.05, 0.05}, 0.0);
  EXPECT_GT(map.all().front().seen_over_m, 1e9);
}

TEST(SurfelMap, ForgetsWhatIsErasedAndLearnsItAnew) {
  SurfelMap map = empty_map();
  map.add({0.05, 0.05});
  map.add({1.05, 0.05});
  map.erase({0, 0});
  map.erase({0, 0});
  map.erase({3, 3});
  EXPECT_EQ(map.all().size(), 1U);
  EXPECT_FALSE(map.nearest({0.05, 0.05}, 2));
  map.add({0.20, 0.20});
  EXPECT_NEAR((map.nearest({0.2, 0.2}, 1)->mean_m - Vector2d(0.20, 0.20)).norm(), 0.0, 1e-7);
}

TEST(SurfelMap, ChangesTheDirectionWhenANeighbourChanges) {
  SurfelMap map = empty_map();
  map.add({0.125, 0.125});
  map.add({0.375, 0.125});
  EXPECT_NEAR(std::abs(map.nearest({0.125, 0.125}, 1)->normal.y()), 1.0, 1e-6);
  map.erase({1, 0});
  map.add({0.125, 0.375});
  EXPECT_NEAR(std::abs(map.nearest({0.125, 0.125}, 1)->normal.x()), 1.0, 1e-6);
}

TEST(SurfelMap, MovesWithTheWorld) {
  const Vector2d by_m(400 * kCell_m, -12 * kCell_m);
  SurfelMap here = empty_map();
  SurfelMap there(window_around(by_m, 20.0, kCell_m), kManyEchoes);
  for (const Vector2d& point_m : scattered_points(500, 12)) {
    here.add(point_m);
    there.add(point_m + by_m);
  }
  const auto all_here = here.all();
  const auto all_there = there.all();
  ASSERT_EQ(all_here.size(), all_there.size());
  for (std::size_t i = 0; i < all_here.size(); ++i) {
    EXPECT_NEAR((all_here[i].mean_m + by_m - all_there[i].mean_m).norm(), 0.0, 1e-6);
    EXPECT_NEAR((all_here[i].normal - all_there[i].normal).norm(), 0.0, 1e-3);
  }
}

TEST(SurfelMap, MovedToAnotherWindowKeepsWhatLiesInBoth) {
  SurfelMap map = empty_map();
  for (const Vector2d& point_m : scattered_points(500, 13)) map.add(point_m);
  const GridWindow next_window = window_around({5.0, 3.0}, 10.0, kCell_m);
  const SurfelMap next = map.moved_to(next_window);
  std::size_t shared = 0;
  for (const SurfelView& surfel : map.all()) {
    if (!next_window.contains(surfel.cell)) continue;
    ++shared;
    const auto kept = next.nearest(surfel.mean_m, 1);
    ASSERT_TRUE(kept);
    EXPECT_EQ(kept->mean_m, surfel.mean_m);
    EXPECT_EQ(kept->weight, surfel.weight);
    EXPECT_EQ(kept->own_echoes, 0.0);
  }
  EXPECT_GT(shared, 50U);
  EXPECT_EQ(next.all().size(), shared);
}

TEST(SurfelMap, IsWhatItsMomentsAre) {
  SurfelMap map = map_of_wall({0.1, 0.2}, 0.5, 0.03);
  SurfelMap copy = empty_map();
  for (const SurfelView& surfel : map.all())
    copy.set_moments(surfel.cell, *map.moments_at(surfel.cell));
  const auto expected = map.all();
  const auto copied = copy.all();
  ASSERT_EQ(copied.size(), expected.size());
  for (std::size_t i = 0; i < copied.size(); ++i) {
    EXPECT_EQ(copied[i].mean_m, expected[i].mean_m);
    EXPECT_EQ(copied[i].normal, expected[i].normal);
    EXPECT_EQ(copied[i].own_echoes, expected[i].own_echoes);
  }
}

TEST(SurfelMap, HasNoMomentsWhereThereWasNoEcho) {
  SurfelMap map = empty_map();
  EXPECT_EQ(map.moments_at({0, 0}), nullptr);
  EXPECT_EQ(map.moments_at({100000, 0}), nullptr);
  map.add({0.1, 0.1});
  map.erase({0, 0});
  EXPECT_EQ(map.moments_at({0, 0}), nullptr);
}

}  // namespace
}  // namespace slammot::grids
