#include "common/sensing/spatial_mounting.hpp"

#include <numbers>

#include <gtest/gtest.h>

namespace slammot::sensing {
namespace {

constexpr double kPi = std::numbers::pi;

void expect_near(const Eigen::Vector3d& point_m, const Eigen::Vector3d& wanted_m) {
  EXPECT_LT((point_m - wanted_m).norm(), 1e-9) << point_m.transpose();
}

TEST(SpatialMounting, WithoutTiltIsThePlanarOneAtItsHeight) {
  const SpatialMounting mounting = in_space({1.0, 0.5, 0.5 * kPi}, {0.6, 0.0, 0.0});
  expect_near(point_in_base_m(mounting, 0.0, 2.0), {1.0, 2.5, 0.6});
  EXPECT_FALSE(scans_vertically(mounting));
}

TEST(SpatialMounting, WithItsNoseUpScansAcrossTheVehicle) {
  const SpatialMounting mounting = in_space({1.0, 0.0, 0.0}, {2.0, 0.0, -0.5 * kPi});
  EXPECT_TRUE(scans_vertically(mounting));
  expect_near(point_in_base_m(mounting, 0.0, 3.0), {1.0, 0.0, 5.0});
  expect_near(point_in_base_m(mounting, 0.5 * kPi, 3.0), {1.0, 3.0, 2.0});
}

TEST(SpatialMounting, RolledOverAndTurnedToTheLeftScansTheLeftSide) {
  const SpatialMounting mounting = in_space({0.0, 0.0, 0.5 * kPi}, {2.0, 0.5 * kPi, 0.0});
  EXPECT_TRUE(scans_vertically(mounting));
  expect_near(point_in_base_m(mounting, 0.0, 3.0), {0.0, 3.0, 2.0});
  expect_near(point_in_base_m(mounting, 0.5 * kPi, 3.0), {0.0, 0.0, 5.0});
}

TEST(SpatialMounting, UpsideDownIsNotVertical) {
  EXPECT_FALSE(scans_vertically(Tilt{0.3, kPi, 0.0}));
  EXPECT_FALSE(scans_vertically(Tilt{0.3, 0.0, 0.2}));
}

}  // namespace
}  // namespace slammot::sensing
