#include "common/city_model/accuracy.hpp"

#include <gtest/gtest.h>

namespace slammot::city_model {
namespace {

PlacedEcho at(float x_m, float y_m) { return {Eigen::Vector3f(x_m, y_m, 2.0F), 0, 0}; }

/// A wall along y = 5 of the world, 12 m high; the map's origin is 5 m up the world's y axis.
ModelTruth one_wall() { return {{0.0, 5.0, 0.0}, {{{-10.0, 5.0}, {10.0, 5.0}, 12.0, true}}, {}}; }

TEST(ModelAccuracy, MeasuresPointsFromTheNearestSurface) {
  CityModel model;
  model.points = {at(0.0F, 0.1F), at(3.0F, -0.1F), at(-4.0F, 0.1F), at(0.0F, 3.0F)};
  const ModelAccuracy accuracy = judge(model, one_wall());
  EXPECT_NEAR(accuracy.point_distance_m.median, 0.1, 1e-6);
  EXPECT_EQ(accuracy.point_distance_m.max, kAstray_m);
  EXPECT_EQ(accuracy.astray_share, 0.25);
}

TEST(ModelAccuracy, ComparesTopsOfFacadesOnWallsOnly) {
  CityModel model;
  model.facades = {{{0.0, 0.1}, {0.5, 0.1}, 0.0, 11.5}, {{0.0, 3.0}, {0.5, 3.0}, 0.0, 1.5}};
  const ModelAccuracy accuracy = judge(model, one_wall());
  EXPECT_EQ(accuracy.wall_top_error_m.count, 1U);
  EXPECT_NEAR(accuracy.wall_top_error_m.median, 0.5, 1e-6);
  EXPECT_NEAR(accuracy.wall_top_bias_m, -0.5, 1e-6);
}

TEST(ModelAccuracy, CountsEchoesOfMovers) {
  CityModel model;
  model.points = {at(0.0F, 0.0F), at(1.0F, 0.0F), at(2.0F, 0.0F), at(3.0F, 0.0F)};
  ModelTruth truth = one_wall();
  truth.is_of_mover = {0, 1, 0, 0};
  EXPECT_EQ(judge(model, truth).residue_share, 0.25);
}

}  // namespace
}  // namespace slammot::city_model
