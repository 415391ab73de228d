#include "services/loop_closing/registration.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Cholesky>

#include <gtest/gtest.h>

#include "tests/support/floor_plan.hpp"
#include "tests/support/matchers.hpp"

namespace slammot::loop_closing {
namespace {

using geometry::Pose2;
using slammot::testing::FloorPlan;
using slammot::testing::PoseNear;
using slammot::testing::submap_seen_from;

FloorPlan room() {
  FloorPlan plan;
  plan.add_box({-6, -4}, {6, 4});
  plan.add_box({2, 1}, {3, 2.5});
  return plan;
}

FloorPlan corridor() {
  FloorPlan plan;
  plan.add({-40, -1}, {40, -1});
  plan.add({-40, 1}, {40, 1});
  return plan;
}

const Pose2 kFirst{0.0, 0.0, 0.0};
const Pose2 kSecond{1.0, -0.5, 0.4};

Registration registered(const FloorPlan& plan, const Pose2& guess_error,
                        const RegistrationConfig& config = {}) {
  const auto target = submap_seen_from(plan, 0, {kFirst});
  const auto source = submap_seen_from(plan, 1, {kSecond});
  return register_surfels(source.surfels, SurfelIndex(target.surfels, 1.0), kSecond * guess_error,
                          config);
}

TEST(RegisterSurfels, ConvergesFromANoisyGuess) {
  const Registration registration = registered(room(), {0.15, -0.1, 0.04});
  EXPECT_THAT(registration.target_from_source.pose, PoseNear(kSecond, 0.01));
  EXPECT_GT(registration.matched_share, 0.9);
  EXPECT_LT(registration.rms_m, 0.03);
}

TEST(RegisterSurfels, PairsTwoAndAHalfTimesAsFarApartInTheFirstSteps) {
  RegistrationConfig config;
  config.fine_gate_m = 0.2;
  EXPECT_DOUBLE_EQ(coarse_gate_m(config), 0.5);
}

TEST(RegisterSurfels, HasAnErrorWithinItsCovariance) {
  const Registration registration = registered(room(), {0.1, 0.1, -0.03});
  const Pose2& pose = registration.target_from_source.pose;
  const geometry::Matrix3& covariance = registration.target_from_source.covariance;
  EXPECT_LT(std::abs(pose.x_m - kSecond.x_m), 3.0 * std::sqrt(covariance(0, 0)));
  EXPECT_LT(std::abs(pose.y_m - kSecond.y_m), 3.0 * std::sqrt(covariance(1, 1)));
  EXPECT_LT(std::abs(pose.heading_rad - kSecond.heading_rad), 3.0 * std::sqrt(covariance(2, 2)));
  EXPECT_LT(std::sqrt(covariance(0, 0)), 0.1);
}

TEST(RegisterSurfels, HasACovarianceOfTheIndependentSurfelsPlusTheFloor) {
  RegistrationConfig config;
  const auto variances = [&](double independent_share, double position_floor_m,
                             double heading_floor_rad) -> Eigen::Vector3d {
    config.independent_share = independent_share;
    config.position_floor_m = position_floor_m;
    config.heading_floor_rad = heading_floor_rad;
    return registered(room(), {0.05, 0.05, 0.01}, config).target_from_source.covariance.diagonal();
  };
  const Eigen::Vector3d by_walls = variances(0.2, 0.0, 0.0);
  EXPECT_LT((variances(0.05, 0.0, 0.0) - 4.0 * by_walls)
                .cwiseQuotient(4.0 * by_walls)
                .cwiseAbs()
                .maxCoeff(),
            0.01);
  const Eigen::Vector3d floors(0.3 * 0.3, 0.3 * 0.3, 0.04 * 0.04);
  EXPECT_LT((variances(0.2, 0.3, 0.04) - by_walls - floors).cwiseAbs().maxCoeff(), 1e-9);
}

/// Surfels of a room, 20 cm apart. The walls are displaced by as much for two metres, one sigma
/// sigma_m; then by something else.
std::vector<flow::Surfel> displaced_room(double sigma_m, std::mt19937& random) {
  constexpr int kWithOneError = 10;
  constexpr double kHalfLengthM = 10.0;
  constexpr double kHalfWidthM = 8.0;
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<flow::Surfel> surfels;
  const auto add_wall = [&](double distance_m, double half_m, bool is_along_x) {
    double error_m = 0.0;
    const int surfels_of_wall = static_cast<int>(std::lround(2.0 * half_m / 0.2));
    for (int i = 0; i < surfels_of_wall; ++i) {
      if (i % kWithOneError == 0) error_m = sigma_m * normal(random);
      const auto along_m = static_cast<float>(0.1 + 0.2 * i - half_m);
      const auto across_m = static_cast<float>(distance_m + error_m);
      const float inwards = distance_m > 0.0 ? -1.0F : 1.0F;
      surfels.push_back(is_along_x ? flow::Surfel{along_m, across_m, 0.0F, inwards, 10.0F}
                                   : flow::Surfel{across_m, along_m, inwards, 0.0F, 10.0F});
    }
  };
  for (const double side : {-1.0, 1.0}) {
    add_wall(side * kHalfWidthM, kHalfLengthM, true);
    add_wall(side * kHalfLengthM, kHalfWidthM, false);
  }
  return surfels;
}

TEST(RegisterSurfels, HasAnHonestCovarianceWhereTwoMetresOfWallShareAnError) {
  RegistrationConfig config;
  config.position_floor_m = config.heading_floor_rad = 0.0;
  std::mt19937 random(1);
  const SurfelIndex target(displaced_room(0.0, random), 1.0);
  constexpr int kRuns = 200;
  double nees = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const std::vector<flow::Surfel> source = displaced_room(config.surfel_sigma_m, random);
    const Registration registration = register_surfels(source, target, Pose2::identity(), config);
    const Pose2& pose = registration.target_from_source.pose;
    const Eigen::Vector3d error(pose.x_m, pose.y_m, pose.heading_rad);
    nees += error.dot(registration.target_from_source.covariance.ldlt().solve(error)) / kRuns;
  }
  EXPECT_GT(nees, 2.0);
  EXPECT_LT(nees, 4.0);  // 3 are expected
}

TEST(RegisterSurfels, HasAWideCovarianceAlongACorridor) {
  const Registration registration = registered(corridor(), {0.0, 0.1, 0.02});
  EXPECT_GT(std::sqrt(registration.target_from_source.covariance(0, 0)), 1.0);
  EXPECT_LT(std::sqrt(registration.target_from_source.covariance(1, 1)), 0.1);
  EXPECT_NEAR(registration.target_from_source.pose.y_m, kSecond.y_m, 0.02);
}

TEST(RegisterSurfels, StaysAtTheGuessWhenNothingMatches) {
  const auto source = submap_seen_from(room(), 1, {kSecond});
  const Registration registration =
      register_surfels(source.surfels, SurfelIndex({}, 1.0), kSecond, {});
  EXPECT_EQ(registration.matched_share, 0.0);
  EXPECT_THAT(registration.target_from_source.pose, PoseNear(kSecond, 1e-12));
}

}  // namespace
}  // namespace slammot::loop_closing
