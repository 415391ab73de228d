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

TEST(PredictedVehicle, TurnsAndStraightensOut) {
  const double yaw_rate_radps = 0.2;
  const PredictedBoxes boxes = predict({{10.0, 5.0, 0.0}, 8.0, 0.0, yaw_rate_radps}, kConfig);
  ASSERT_EQ(boxes.size(), 41U);
  const double radius_m = 8.0 / yaw_rate_radps;
  const OrientedBox& soon = boxes[step_at(0.3)].box;  // nearly on the arc of the present turn
  EXPECT_NEAR(soon.centre.x_m, 10.0 + radius_m * std::sin(0.06), 1e-2);
  EXPECT_NEAR(soon.centre.y_m, 5.0 + radius_m * (1.0 - std::cos(0.06)), 1e-2);
  EXPECT_LT(boxes.back().box.centre.heading_rad, 0.7 * 4.0 * yaw_rate_radps);
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

/// Drives along x at 10 m/s.
flow::TrackedObject car() {
  flow::TrackedObject car;
  car.position_in_odom_m = {20.0, 1.0};
  car.velocity_in_odom_mps = {10.0, 0.0};
  car.covariance.topLeftCorner<2, 2>() = 0.04 * Matrix2d::Identity();
  car.covariance.bottomRightCorner<2, 2>() = 0.09 * Matrix2d::Identity();
  car.object_class = flow::ObjectClass::kCar;
  car.length_m = 4.5;
  car.width_m = 1.8;
  return car;
}

TEST(PredictedObject, BrakesUntilItStands) {
  const PredictedBoxes boxes = predict(car(), {0.0, 10.0, -5.0, 0.0}, std::nullopt, kConfig);
  EXPECT_NEAR(boxes[step_at(1.0)].box.centre.x_m, 27.5, 1e-6);
  EXPECT_NEAR(boxes[step_at(2.0)].box.centre.x_m, 30.0, 1e-6);
  EXPECT_NEAR(boxes.back().box.centre.x_m, 30.0, 1e-6);
}

TEST(PredictedObject, HoldsASpeedThatIncreases) {
  EXPECT_NEAR(predict(car(), {0.0, 10.0, 2.0, 0.0}, std::nullopt, kConfig).back().box.centre.x_m,
              60.0, 1e-6);
}

TEST(PredictedObject, TurnsAndStraightensOut) {
  const PredictedBoxes boxes = predict(car(), {0.0, 10.0, 0.0, 0.2}, std::nullopt, kConfig);
  EXPECT_NEAR(boxes[step_at(0.5)].box.centre.heading_rad, 0.092, 0.01);
  EXPECT_GT(boxes.back().box.centre.heading_rad, 0.35);
  EXPECT_LT(boxes.back().box.centre.heading_rad, 0.5);  // 0.8 without an end
  EXPECT_GT(boxes.back().box.centre.y_m, 5.0);
}

TEST(PredictedObject, KeepsTheHeadingOfItsBoxAgainstItsCourse) {
  flow::TrackedObject object = car();
  object.heading_in_odom_rad = 0.1;
  for (const PredictedBox& there : predict(object, {0.0, 10.0, 0.0, 0.0}, std::nullopt, kConfig))
    EXPECT_NEAR(there.box.centre.heading_rad, 0.1, 1e-9);
}

TEST(PredictedObject, SigmaGrowsByThatOfItsVelocityAndByWhatItsDriverMayDo) {
  CourseState motion{0.0, 10.0, 0.0, 0.0};
  motion.turn_covariance(0, 0) = 0.02 * 0.02;
  const PredictedBoxes boxes = predict(car(), motion, std::nullopt, kConfig);
  const Matrix2d& covariance_m2 = boxes[step_at(2.0)].covariance_m2;
  EXPECT_NEAR(covariance_m2(0, 0),
              0.04 + 4.0 * 0.09 + std::pow(2.0 * kConfig.acceleration_sigma_mps2, 2), 1e-9);
  EXPECT_NEAR(covariance_m2(1, 1),
              0.04 + std::pow(20.0 * 0.02, 2) + std::pow(20.0 * kConfig.yaw_rate_sigma_radps, 2),
              1e-9);
  EXPECT_NEAR(boxes.front().covariance_m2(0, 0), 0.04, 1e-9);
}

TEST(PredictedObject, EndsALaneChangeInALane) {
  const PredictedBoxes boxes = predict(car(), {-0.2, 10.0, 0.0, 0.0}, 0.0, kConfig);
  EXPECT_NEAR(boxes.back().box.centre.heading_rad, 0.2, 0.02);  // 0.2 more than the box has now
  EXPECT_NEAR(boxes.back().box.centre.y_m, 1.0 - 10.0 * 0.2 * 1.2, 0.3);  // -7 without a road
}

TEST(PredictedObject, KeepsToItsSideIfItComesAgainst) {
  const PredictedBoxes boxes = predict(car(), {3.0, 10.0, 0.0, 0.0}, 0.0, kConfig);
  EXPECT_NEAR(boxes.back().box.centre.y_m, 1.0 + 10.0 * (std::numbers::pi - 3.0) * 1.2, 0.3);
}

TEST(PredictedObject, CrossesTheRoadIfItsCourseIsAcross) {
  const PredictedBoxes boxes = predict(car(), {1.2, 10.0, 0.0, 0.0}, 0.0, kConfig);
  EXPECT_NEAR(boxes.back().box.centre.y_m, 1.0 + 40.0 * std::sin(1.2), 1e-6);
}

TEST(Road, IsUnknownWhileTheVehicleTurns) {
  EXPECT_EQ(road_of({{0.0, 0.0, 0.4}, 8.0, 0.0, 0.05}), 0.4);
  EXPECT_FALSE(road_of({{0.0, 0.0, 0.4}, 8.0, 0.0, 0.3}));
}

TEST(PredictedObject, IsAsUncertainToAllSidesIfItIsAPedestrian) {
  flow::TrackedObject pedestrian = car();
  pedestrian.object_class = flow::ObjectClass::kPedestrian;
  const Matrix2d covariance_m2 =
      predict(pedestrian, {0.7, 1.5, 0.0, 0.0}, 0.5, kConfig)[step_at(2.0)].covariance_m2;
  const double expected_m2 =
      0.04 + 4.0 * 0.09 + std::pow(2.0 * kConfig.pedestrian_acceleration_sigma_mps2, 2);
  EXPECT_NEAR(covariance_m2(0, 0), expected_m2, 1e-9);
  EXPECT_NEAR(covariance_m2(1, 1), expected_m2, 1e-9);
  EXPECT_NEAR(covariance_m2(0, 1), 0.0, 1e-9);
}

}  // namespace
}  // namespace slammot::collision_warning
