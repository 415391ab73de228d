#include "services/collision_warning/predicted_motion.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace slammot::collision_warning {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

const CollisionWarningConfig kConfig;

std::size_t step_at(double after_s) {
  return static_cast<std::size_t>(std::lround(after_s / kPredictionStepS));
}

TEST(PredictedVehicle, GoesRoundACircle) {
  const double yaw_rate_radps = 0.5 * std::numbers::pi / 4.0;  // a quarter in 4 s
  const PredictedBoxes boxes = predict({{10.0, 5.0, 0.0}, 8.0, 0.0, yaw_rate_radps}, kConfig);
  ASSERT_EQ(boxes.size(), 41U);
  const double radius_m = 8.0 / yaw_rate_radps;
  EXPECT_NEAR(boxes.back().box.centre.x_m, 10.0 + radius_m, 1e-6);
  EXPECT_NEAR(boxes.back().box.centre.y_m, 5.0 + radius_m, 1e-6);
  EXPECT_NEAR(boxes.back().box.centre.heading_rad, 0.5 * std::numbers::pi, 1e-9);
}

TEST(PredictedVehicle, StandsWhereItsBrakingEnds) {
  const PredictedBoxes boxes = predict({{0.0, 0.0, 0.0}, 6.0, -4.0, 0.0}, kConfig);
  EXPECT_NEAR(boxes[step_at(1.0)].box.centre.x_m, 4.0, 1e-9);
  EXPECT_NEAR(boxes[step_at(1.5)].box.centre.x_m, 4.5, 1e-9);
  EXPECT_NEAR(boxes.back().box.centre.x_m, 4.5, 1e-9);
}

TEST(PredictedVehicle, HoldsASpeedThatIncreases) {
  EXPECT_NEAR(predict({{0.0, 0.0, 0.0}, 6.0, 2.0, 0.0}, kConfig).back().box.centre.x_m, 24.0, 1e-9);
}

TEST(PredictedVehicle, DoesNotTurnWhileItStands) {
  const PredictedBoxes boxes = predict({{1.0, 2.0, 0.3}, 0.0, 0.0, 0.05}, kConfig);
  EXPECT_NEAR(boxes.back().box.centre.heading_rad, 0.3, 1e-9);
}

TEST(PredictedVehicle, PutsItsFootprintAroundItsCentre) {
  CollisionWarningConfig config;
  config.vehicle_centre_ahead_m = 1.4;  // base on the rear axle
  const PredictedBoxes boxes = predict({{0.0, 0.0, 0.5 * std::numbers::pi}, 0.0, 0.0, 0.0}, config);
  EXPECT_NEAR(boxes.front().box.centre.y_m, 1.4, 1e-9);
}

TEST(PredictedVehicle, SigmaFollowsFromWhatTheDriverMayDo) {
  const PredictedBoxes boxes =
      predict({{0.0, 0.0, 0.5 * std::numbers::pi}, 10.0, 0.0, 0.0}, kConfig);
  const Matrix2d& covariance_m2 = boxes[step_at(2.0)].covariance_m2;
  EXPECT_NEAR(std::sqrt(covariance_m2(1, 1)), 2.0 * kConfig.acceleration_sigma_mps2, 1e-9);
  EXPECT_NEAR(std::sqrt(covariance_m2(0, 0)), 20.0 * kConfig.yaw_rate_sigma_radps, 1e-9);
  EXPECT_TRUE(boxes.front().covariance_m2.isZero());
}

/// Brakes at 2 m/s^2; its path as tracking publishes it, in steps of `step_s`.
flow::TrackedObject braking_car(double step_s) {
  flow::TrackedObject car;
  car.position_in_odom_m = {20.0, 1.0};
  car.velocity_in_odom_mps = {10.0, 0.0};
  car.covariance.topLeftCorner<2, 2>() = 0.04 * Matrix2d::Identity();
  car.length_m = 4.5;
  car.width_m = 1.8;
  for (double t = step_s; t < 3.01; t += step_s)
    car.predicted_path.push_back(
        {t, {20.0 + 10.0 * t - t * t, 1.0}, (0.04 + 0.25 * t) * Matrix2d::Identity()});
  return car;
}

TEST(PredictedObject, FollowsItsPublishedPath) {
  for (const double step_s : {0.5, 1.0}) {
    const PredictedBoxes boxes = predict(braking_car(step_s), kConfig);
    for (const double t : {0.0, 0.3, 0.7, 1.2, 1.5, 2.0}) {
      const PredictedBox& there = boxes[step_at(t)];
      EXPECT_NEAR(there.box.centre.x_m, 20.0 + 10.0 * t - t * t, 0.02) << t;
      EXPECT_NEAR(there.box.centre.y_m, 1.0, 1e-9);
      EXPECT_NEAR(there.covariance_m2(0, 0), 0.04 + 0.25 * t, 1e-9) << t;
    }
  }
}

TEST(PredictedObject, GoesStraightOnBeyondItsPath) {
  const PredictedBoxes boxes = predict(braking_car(0.5), kConfig);
  EXPECT_NEAR(boxes.back().box.centre.x_m, 41.0 + 4.5, 0.1);
  EXPECT_NEAR(boxes.back().covariance_m2(0, 0), 0.79 * 16.0 / 9.0, 1e-9);
}

TEST(PredictedObject, KeepsItsVelocityWithoutAPath) {
  flow::TrackedObject car = braking_car(0.5);
  car.predicted_path.clear();
  car.covariance.bottomRightCorner<2, 2>() = 0.25 * Matrix2d::Identity();
  const PredictedBoxes boxes = predict(car, kConfig);
  EXPECT_NEAR(boxes[step_at(2.0)].box.centre.x_m, 40.0, 1e-9);
  EXPECT_GE(boxes[step_at(2.0)].covariance_m2(1, 1), 0.04 + 4.0 * 0.25);
}

}  // namespace
}  // namespace slammot::collision_warning
