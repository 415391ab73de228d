#include "services/collision_warning/encounter.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace slammot::collision_warning {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

/// A box on a straight way through `from_m`, with sigmas that grow with time.
PredictedBoxes straight(const Vector2d& from_m, const Vector2d& velocity_mps,
                        const OrientedBox& box, const Vector2d& sigma_mps) {
  PredictedBoxes boxes;
  for (int i = 0; i <= 40; ++i) {
    const double t = kPredictionStepS * i;
    PredictedBox predicted{box, Matrix2d::Zero()};
    predicted.box.centre.x_m = from_m.x() + t * velocity_mps.x();
    predicted.box.centre.y_m = from_m.y() + t * velocity_mps.y();
    predicted.covariance_m2 = (t * sigma_mps).cwiseAbs2().asDiagonal();
    boxes.push_back(predicted);
  }
  return boxes;
}

const OrientedBox kCar{{}, 4.4, 1.8};
const OrientedBox kPedestrian{{}, 0.5, 0.5};
const PredictedBoxes kVehicle = straight({0.0, 0.0}, {8.0, 0.0}, kCar, {0.0, 0.0});

TEST(Contact, IsCertainAndPunctualWithoutUncertainty) {
  const auto found = contact(kVehicle, straight({20.4, 0.0}, {0.0, 0.0}, kCar, {0.0, 0.0}));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->probability, 1.0);
  EXPECT_NEAR(found->after_s, 2.0, 0.051);  // a gap of 16 m
}

TEST(Contact, IsNoneBesideTheWay) {
  EXPECT_FALSE(contact(kVehicle, straight({20.0, 3.5}, {0.0, 0.0}, kCar, {0.0, 0.3})));
}

TEST(Contact, IsNoneWithWhatMovesAway) {
  EXPECT_FALSE(contact(kVehicle, straight({15.0, 0.0}, {10.0, 0.0}, kCar, {0.3, 0.1})));
}

/// Oracle: each sample of the velocity is a trajectory of its own.
double probability_by_sampling(const Vector2d& from_m, const Vector2d& velocity_mps,
                               const Vector2d& sigma_mps) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  constexpr int kDraws = 20'000;
  int contacts = 0;
  for (int i = 0; i < kDraws; ++i) {
    const Vector2d error{sigma_mps.x() * normal(random), sigma_mps.y() * normal(random)};
    if (contact(kVehicle, straight(from_m, velocity_mps + error, kPedestrian, {0.0, 0.0})))
      ++contacts;
  }
  return static_cast<double>(contacts) / kDraws;
}

TEST(Contact, HasTheProbabilityOfAllVelocitiesThatLeadToIt) {
  struct Case {
    Vector2d from_m, velocity_mps, sigma_mps;
  };
  for (const Case& c :
       {Case{{20.0, -4.0}, {0.0, 1.5}, {0.3, 0.3}}, Case{{20.0, -4.0}, {0.0, 1.0}, {0.3, 0.3}},
        Case{{20.0, -2.5}, {0.0, 0.0}, {0.5, 0.5}}, Case{{24.0, 0.0}, {-1.0, 0.2}, {0.2, 0.8}}}) {
    const auto found =
        contact(kVehicle, straight(c.from_m, c.velocity_mps, kPedestrian, c.sigma_mps));
    const double expected = probability_by_sampling(c.from_m, c.velocity_mps, c.sigma_mps);
    EXPECT_NEAR(found ? found->probability : 0.0, expected, 0.07);
  }
}

TEST(Contact, DoesNotDependOnTheAxesOfTheFrame) {
  const Vector2d sigma_mps{0.4, 0.1};
  PredictedBoxes vehicle = kVehicle;
  PredictedBoxes other = straight({20.0, -4.0}, {0.0, 1.2}, kPedestrian, sigma_mps);
  const double probability = contact(vehicle, other)->probability;
  const geometry::Pose2 turned_from_frame{7.0, -3.0, 0.9};
  for (PredictedBoxes* boxes : {&vehicle, &other}) {
    for (PredictedBox& box : *boxes) {
      const Matrix2d turn = geometry::rotation(turned_from_frame.heading_rad);
      box.box.centre = turned_from_frame * box.box.centre;
      box.covariance_m2 = turn * box.covariance_m2 * turn.transpose();
    }
  }
  EXPECT_NEAR(contact(vehicle, other)->probability, probability, 0.06);
}

TEST(ClosestApproach, IsWhereThePathsAreNearest) {
  // Passes the lane's middle 3 s from now, when the vehicle is at 24 m.
  const ClosestApproach closest =
      closest_approach(kVehicle, straight({40.0, 3.0}, {-8.0, 0.0}, kCar, {0.0, 0.0}));
  EXPECT_NEAR(closest.distance_m, 3.0 - 1.8, 1e-9);
  EXPECT_NEAR(closest.after_s, (40.0 - 4.4) / 16.0, 0.11);
}

}  // namespace
}  // namespace slammot::collision_warning
