#include "common/graphs/place_of_map.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>

#include <gtest/gtest.h>

#include "common/simulation/random.hpp"

namespace slammot::graphs {
namespace {

using geometry::Matrix2;
using geometry::Matrix3;
using geometry::Pose2;
using geometry::Vector2;
using simulation::Random;

const Pose2 kEnuFromMap{60.0, -35.0, 0.8};
constexpr double kNoise_m = 1.2;
constexpr double kStep_m = 3.0;

/// Constant offset of the fixes between two places of the way.
struct Stretch {
  double begin_m;
  double end_m;
  Vector2 offset_m;
};

struct Drive {
  double way_m = 400.0;
  double usual_sigma_m = 2.0;  ///< Correlated over 15 m.
  std::vector<Stretch> stretches;
};

/// Twice around a corner: 150 m to the east, 120 m to the north, and west.
Vector2 place_at(double way_m) {
  if (way_m < 150.0) return {way_m, 0.0};
  if (way_m < 270.0) return {150.0, way_m - 150.0};
  return {150.0 - (way_m - 270.0), 120.0};
}

std::vector<Fix> fixes_of(const Drive& drive, Random& random) {
  const double kept = std::exp(-kStep_m / 15.0);
  Vector2 drift_m = drive.usual_sigma_m * Vector2(random.normal(), random.normal());
  std::vector<Fix> fixes;
  for (double way_m = 0.0; way_m < drive.way_m; way_m += kStep_m) {
    drift_m = kept * drift_m + drive.usual_sigma_m * std::sqrt(1.0 - kept * kept) *
                                   Vector2(random.normal(), random.normal());
    Vector2 error_m = drift_m + kNoise_m * Vector2(random.normal(), random.normal());
    for (const Stretch& stretch : drive.stretches) {
      if (way_m < stretch.begin_m || way_m >= stretch.end_m) continue;
      error_m += stretch.offset_m;
      break;
    }
    const Vector2 in_map_m = place_at(way_m);
    fixes.push_back({in_map_m, kEnuFromMap * in_map_m + error_m,
                     kNoise_m * kNoise_m * Matrix2::Identity(), fixes.empty() ? 0.0 : kStep_m});
  }
  return fixes;
}

/// Three stretches of 60 to 150 m, 20 to 60 m off.
Drive under_lasting_multipath(Random& random) {
  Drive drive;
  for (int i = 0; i < 3; ++i) {
    const double length_m = random.uniform(60.0, 150.0);
    const double begin_m = random.uniform(0.0, drive.way_m - length_m);
    const double size_m = random.uniform(20.0, 60.0);
    const double direction_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
    drive.stretches.push_back({begin_m, begin_m + length_m,
                               size_m * Vector2(std::cos(direction_rad), std::sin(direction_rad))});
  }
  return drive;
}

/// Squared error of the pose, normalized by the spread of the density about it: mean 3 if honest.
double nees(const std::vector<Fix>& fixes) {
  const std::vector<PlaceMode> modes = place_of_map(fixes);
  const Pose2 best = modes.front().enu_from_map;
  const Eigen::Vector3d error = geometry::difference(best, kEnuFromMap);
  return error.dot(spread_about(best, modes).ldlt().solve(error));
}

TEST(FixLikelihood, GradientIsThatOfTheLogarithmWhereOneRegimeIsCertain) {
  Random random(5, simulation::Purpose::gnss);
  const std::vector<Fix> fixes = fixes_of({}, random);
  const Pose2 pose{60.7, -34.2, 0.802};
  const FixErrorModel model;
  const FixLikelihood at = likelihood(fixes, pose, model);
  constexpr double kSmall = 1e-5;
  for (int i = 0; i < 3; ++i) {
    Pose2 low = pose;
    Pose2 high = pose;
    (i == 0 ? low.x_m : i == 1 ? low.y_m : low.heading_rad) -= kSmall;
    (i == 0 ? high.x_m : i == 1 ? high.y_m : high.heading_rad) += kSmall;
    const double numerical =
        (likelihood(fixes, high, model).logarithm - likelihood(fixes, low, model).logarithm) /
        (2.0 * kSmall);
    EXPECT_NEAR(at.gradient(i), numerical, 0.15 * std::abs(numerical) + 1.0) << i;
  }
}

TEST(FixLikelihood, CountsALastingOffsetOnceHoweverManyFixesHaveIt) {
  Random random(6, simulation::Purpose::gnss);
  const auto loss = [&](double until_m) {
    const std::vector<Fix> with = fixes_of({.stretches = {{60.0, until_m, {30.0, 20.0}}}}, random);
    const std::vector<Fix> without = fixes_of({}, random);
    return likelihood(without, kEnuFromMap, {}).logarithm -
           likelihood(with, kEnuFromMap, {}).logarithm;
  };
  EXPECT_LT(loss(120.0), 40.0);
  EXPECT_NEAR(loss(240.0), loss(120.0), 25.0);
}

TEST(PlaceOfMap, IsNotMovedByMultipathThatLastsForHalfTheWay) {
  Random random(8, simulation::Purpose::gnss);
  const std::vector<Fix> fixes =
      fixes_of({.stretches = {{60.0, 150.0, {40.0, 10.0}}, {250.0, 350.0, {-30.0, 25.0}}}}, random);
  const std::vector<PlaceMode> modes = place_of_map(fixes);
  ASSERT_FALSE(modes.empty());
  EXPECT_NEAR(modes.front().enu_from_map.x_m, kEnuFromMap.x_m, 4.0);
  EXPECT_NEAR(modes.front().enu_from_map.y_m, kEnuFromMap.y_m, 4.0);
}

TEST(PlaceOfMap, IsHonestUnderUsualErrors) {
  double sum = 0.0;
  constexpr int kDrives = 60;
  for (std::uint64_t seed = 1; seed <= kDrives; ++seed) {
    Random random(seed, simulation::Purpose::gnss);
    sum += nees(fixes_of({}, random));
  }
  EXPECT_GT(sum / kDrives, 1.0);
  EXPECT_LT(sum / kDrives, 4.5);
}

TEST(PlaceOfMap, IsHonestWhereMultipathLastsForMostOfTheWay) {
  double sum = 0.0;
  double far = 0.0;
  constexpr int kDrives = 60;
  for (std::uint64_t seed = 101; seed <= 100 + kDrives; ++seed) {
    Random random(seed, simulation::Purpose::gnss);
    const double of_drive = nees(fixes_of(under_lasting_multipath(random), random));
    sum += of_drive;
    far += of_drive > 11.3 ? 1.0 : 0.0;  // 1 % of an honest one
  }
  EXPECT_LT(sum / kDrives, 5.0);
  EXPECT_LE(far / kDrives, 0.1);
}

TEST(PlaceOfMap, IsUnknownWithoutFixes) { EXPECT_TRUE(place_of_map({}).empty()); }

}  // namespace
}  // namespace slammot::graphs
