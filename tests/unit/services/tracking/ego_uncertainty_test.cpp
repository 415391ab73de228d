#include <cmath>
#include <cstdint>
#include <optional>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "services/detection/detector.hpp"
#include "services/tracking/tracker.hpp"
#include "tests/support/street.hpp"

namespace slammot::tracking {
namespace {

using slammot::testing::Street;

constexpr double kPeriodS = 1.0 / 37.5;
constexpr std::uint32_t kScans = 75;

using Variances = Eigen::Vector3d;  ///< Of x, y [m^2] and heading [rad^2].

/// A car that crosses 20 m ahead at 8 m/s, as published after two seconds in which the vehicle's
/// pose was said to be so unsure, and was.
std::optional<flow::TrackedObject> crossing_car(const Variances& said,
                                                const Variances& errors = Variances::Zero(),
                                                unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Tracker tracker{TrackingConfig()};
  Street street;
  street.known = {{{40.0, 0.0, M_PI / 2.0}, 120.0, 1.0}};
  flow::TrackedObjects published;
  for (std::uint32_t scan = 0; scan < kScans; ++scan) {
    const double time_s = scan * kPeriodS;
    street.unknown = {{{20.0, -8.0 + 8.0 * time_s, M_PI / 2.0}}};
    flow::LocalizedScan localized = street.scan(static_cast<std::int64_t>(time_s * 1e9), scan);
    const double x_m = std::sqrt(errors.x()) * normal(random),
                 y_m = std::sqrt(errors.y()) * normal(random),
                 heading_rad = std::sqrt(errors.z()) * normal(random);
    localized.odom_from_base = {{x_m, y_m, heading_rad}, said.asDiagonal()};
    published = tracker.step(detection::detect(localized, {})).objects;
  }
  return published.objects.size() == 1 && published.objects.front().confirmed
             ? std::optional(published.objects.front())
             : std::nullopt;
}

double position_nees(const flow::TrackedObject& car) {
  const Eigen::Vector2d error_m =
      car.position_in_odom_m - Eigen::Vector2d(20.0, -8.0 + 8.0 * (kScans - 1) * kPeriodS);
  return error_m.dot(car.covariance.topLeftCorner<2, 2>().inverse() * error_m);
}

double velocity_nees(const flow::TrackedObject& car) {
  const Eigen::Vector2d error_mps = car.velocity_in_odom_mps - Eigen::Vector2d(0.0, 8.0);
  return error_mps.dot(car.covariance.bottomRightCorner<2, 2>().inverse() * error_mps);
}

TEST(EgoUncertainty, IsInTheTrackInTheDirectionInWhichThePoseIsUnsure) {
  const auto sure = crossing_car({0.0, 0.0, 0.0}), along = crossing_car({0.04, 0.0, 0.0}),
             across = crossing_car({0.0, 0.04, 0.0});
  ASSERT_TRUE(sure && along && across);
  EXPECT_GT(along->covariance(0, 0), 1.3 * sure->covariance(0, 0));
  EXPECT_NEAR(along->covariance(1, 1), sure->covariance(1, 1), 0.02 * sure->covariance(1, 1));
  EXPECT_GT(across->covariance(1, 1), 1.5 * sure->covariance(1, 1));
  EXPECT_NEAR(across->covariance(0, 0), sure->covariance(0, 0), 0.02 * sure->covariance(0, 0));
}

TEST(EgoUncertainty, OfHeadingIsAcrossTheLineOfSightAsFarAsTheCarIsAway) {
  const auto sure = crossing_car({0.0, 0.0, 0.0}), turned = crossing_car({0.0, 0.0, 1e-4}),
             across = crossing_car({0.0, 1e-4 * 20.0 * 20.0, 0.0});
  ASSERT_TRUE(sure && turned && across);
  EXPECT_NEAR(turned->covariance(1, 1), across->covariance(1, 1), 0.1 * across->covariance(1, 1));
  EXPECT_LT(turned->covariance(0, 0), 1.2 * sure->covariance(0, 0));
}

TEST(EgoUncertainty, IsInTheVelocityToo) {
  const auto sure = crossing_car({0.0, 0.0, 0.0}), across = crossing_car({0.0, 0.04, 0.0});
  ASSERT_TRUE(sure && across);
  EXPECT_GT(across->covariance(3, 3), 1.5 * sure->covariance(3, 3));
}

TEST(EgoUncertainty, ThatIsSaidCoversTheErrorsThatItMakes) {
  const Variances errors{0.01, 0.01, 2.5e-5};
  constexpr unsigned kRuns = 40;
  double said_position = 0.0, unsaid_position = 0.0, said_velocity = 0.0, unsaid_velocity = 0.0;
  for (unsigned seed = 1; seed <= kRuns; ++seed) {
    const auto said = crossing_car(errors, errors, seed),
               unsaid = crossing_car(Variances::Zero(), errors, seed);
    ASSERT_TRUE(said) << seed;
    ASSERT_TRUE(unsaid) << seed;
    said_position += position_nees(*said) / kRuns, said_velocity += velocity_nees(*said) / kRuns;
    unsaid_position += position_nees(*unsaid) / kRuns,
        unsaid_velocity += velocity_nees(*unsaid) / kRuns;
  }
  // Two degrees of freedom each.
  EXPECT_LT(said_position, 3.0);
  EXPECT_GT(said_position, 0.3);
  EXPECT_LT(said_velocity, 3.0);
  EXPECT_GT(said_velocity, 0.2);
  EXPECT_GT(unsaid_position, 1.2 * said_position);
  EXPECT_GT(unsaid_velocity, 1.5 * said_velocity);
}

}  // namespace
}  // namespace slammot::tracking
