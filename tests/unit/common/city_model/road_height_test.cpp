#include "common/city_model/road_height.hpp"

#include <gtest/gtest.h>

namespace slammot::city_model {
namespace {

/// Twenty echoes of a road at this height, and a wall beside it from 0.3 m below the base up.
std::vector<Eigen::Vector3d> street(double road_m) {
  std::vector<Eigen::Vector3d> points_m;
  for (int i = 0; i < 20; ++i) points_m.emplace_back(0.0, 1.0 + 0.2 * i, road_m + 0.01 * (i % 3));
  for (int i = 0; i < 13; ++i) points_m.emplace_back(0.0, 5.0, -0.3 + 0.1 * i);
  return points_m;
}

TEST(RoadHeight, IsTheDensestLayerBesideTheVehicle) {
  RoadHeight road;
  road.add(street(-0.4));
  EXPECT_NEAR(road.height_m(), -0.4, 0.03);
}

TEST(RoadHeight, IsThatOfTheBaseWhereTheScannerSeesNoRoad) {
  RoadHeight road;
  road.add(std::vector<Eigen::Vector3d>{{0.0, 3.0, 0.1}, {0.0, 3.0, 5.0}});
  EXPECT_EQ(road.height_m(), 0.0);
}

TEST(RoadHeight, FollowsTheRoadSlowly) {
  RoadHeight road;
  road.add(street(0.0));
  road.add(street(0.3));
  EXPECT_NEAR(road.height_m(), 0.03, 0.02);
  for (int i = 0; i < 60; ++i) road.add(street(0.3));
  EXPECT_NEAR(road.height_m(), 0.3, 0.03);
}

}  // namespace
}  // namespace slammot::city_model
