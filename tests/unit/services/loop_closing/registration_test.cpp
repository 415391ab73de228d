#include "services/loop_closing/registration.hpp"

#include <cmath>

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
