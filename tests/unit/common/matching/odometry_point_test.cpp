#include "common/matching/odometry_point.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"

namespace slammot::matching {
namespace {

using geometry::Pose2;
using testing::PoseNear;

const Pose2 kOdometryFromLaser{1.5, -0.4, 0.08};

struct Errors {
  double sigma_m = 0.0;
  double odometry_scale = 1.0;
  int every_wrong = 0;  ///< One match of so many is a metre off; 0: none.
};

std::vector<PairMotion> motions(std::size_t count, double most_turn_rad, const Errors& errors,
                                unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> turn_rad(-most_turn_rad, most_turn_rad);
  std::normal_distribution<double> error_m(0.0, 1.0);
  std::vector<PairMotion> made;
  for (std::size_t i = 0; i < count; ++i) {
    const double turned_rad = turn_rad(random);
    const Pose2 by_odometry{0.8, 0.4 * turned_rad, turned_rad};
    Pose2 by_scans = inverse(kOdometryFromLaser) * by_odometry * kOdometryFromLaser;
    by_scans.x_m += errors.sigma_m * error_m(random);
    by_scans.y_m += errors.sigma_m * error_m(random);
    const bool is_wrong =
        errors.every_wrong > 0 && i % static_cast<std::size_t>(errors.every_wrong) == 0;
    if (is_wrong) by_scans.x_m -= 1.0;
    made.push_back({{errors.odometry_scale * by_odometry.x_m,
                     errors.odometry_scale * by_odometry.y_m, by_odometry.heading_rad},
                    by_scans});
  }
  return made;
}

TEST(OdometryPoint, IsFoundFromMotionsThatTurn) {
  const auto found = odometry_point(motions(20, 0.4, {}));
  ASSERT_TRUE(found);
  EXPECT_THAT(found->odometry_from_laser, PoseNear(kOdometryFromLaser, 1e-9));
}

TEST(OdometryPoint, IsFoundAmongWrongMatches) {
  const auto found = odometry_point(motions(60, 0.4, {.sigma_m = 0.01, .every_wrong = 6}));
  ASSERT_TRUE(found);
  EXPECT_THAT(found->odometry_from_laser, PoseNear(kOdometryFromLaser, 0.1));
  EXPECT_NEAR(found->odometry_from_laser.heading_rad, kOdometryFromLaser.heading_rad, 0.01);
}

TEST(OdometryPoint, HasItsPlaceAndDirectionWhateverTheWayCounts) {
  const auto found = odometry_point(motions(60, 0.4, {.odometry_scale = 1.2}));
  ASSERT_TRUE(found);
  EXPECT_THAT(found->odometry_from_laser, PoseNear(kOdometryFromLaser, 1e-9));
  EXPECT_NEAR(found->odometry_from_laser.heading_rad, kOdometryFromLaser.heading_rad, 1e-9);
}

TEST(OdometryPoint, IsAsUncertainAsItSays) {
  constexpr unsigned kRuns = 200;
  Pose2 squared{0.0, 0.0, 0.0};
  for (unsigned seed = 1; seed <= kRuns; ++seed) {
    const auto found = odometry_point(motions(60, 0.3, {.sigma_m = 0.03}, seed));
    ASSERT_TRUE(found);
    const auto add = [](double& sum, double error, double sigma) {
      sum += error * error / (sigma * sigma) / kRuns;
    };
    add(squared.x_m, found->odometry_from_laser.x_m - kOdometryFromLaser.x_m, found->sigma.x_m);
    add(squared.y_m, found->odometry_from_laser.y_m - kOdometryFromLaser.y_m, found->sigma.y_m);
    add(squared.heading_rad,
        found->odometry_from_laser.heading_rad - kOdometryFromLaser.heading_rad,
        found->sigma.heading_rad);
  }
  for (const double mean : {squared.x_m, squared.y_m, squared.heading_rad}) {
    EXPECT_GT(mean, 0.4);
    EXPECT_LT(mean, 1.5);
  }
}

TEST(OdometryPoint, IsUnknownWithoutTurnsFromFewMotionsAndFromWheelsThatCountNothing) {
  EXPECT_FALSE(odometry_point(motions(60, 0.0, {})));
  EXPECT_FALSE(odometry_point(motions(10, 0.4, {})));
  EXPECT_FALSE(odometry_point(motions(60, 0.4, {.odometry_scale = 0.0})));
}

}  // namespace
}  // namespace slammot::matching
