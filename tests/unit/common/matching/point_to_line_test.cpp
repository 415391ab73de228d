#include "common/matching/point_to_line.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/LU>

#include "tests/support/help_at_the_last_moment.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/surfels.hpp"
#include "tests/support/synthetic_world.hpp"

namespace slammot::matching {
namespace {

using geometry::Matrix3;
using geometry::Pose2;
using geometry::UncertainPose2;
using geometry::Vector2;
using slammot::testing::MatrixNear;
using slammot::testing::points_seen;
using slammot::testing::PoseNear;
using slammot::testing::surfels_of;
using slammot::testing::World;

constexpr double kCell_m = 0.2;
const Matrix3 kVague = Eigen::Vector3d(1.0, 1.0, 0.1).asDiagonal();

std::vector<MatchPoint> exact_scan_of(const World& world, const Pose2& world_from_base,
                                      int beams = 360) {
  std::mt19937 unused;
  return points_seen(world, world_from_base, beams, 0.0, unused);
}

PointToLineResult match_from(const std::vector<MatchPoint>& points, const grids::SurfelMap& surfels,
                             const Pose2& prior, const PointToLineConfig& config = {}) {
  return PointToLineMatcher().match(points, surfels, {prior, kVague}, prior, config);
}

TEST(PointToLine, FindsThePoseFromAllAround) {
  const World room = slammot::testing::room();
  const auto surfels = surfels_of(room);
  const Pose2 truth{-2.0, 1.0, 0.6};
  const auto points = exact_scan_of(room, truth);
  for (const Pose2& error : {Pose2{0.3, 0.0, 0.0},
                             {-0.3, 0.2, 0.0},
                             {0.0, -0.3, 0.03},
                             {0.1, 0.1, -0.05},
                             {0.0, 0.0, 0.05}}) {
    const auto result = match_from(points, surfels, truth * error);
    EXPECT_THAT(result.map_from_base.pose, PoseNear(truth, 0.005));
    EXPECT_GT(result.matched_share, 0.95);
    EXPECT_LT(result.rms_residual_m, 0.02);
  }
}

TEST(PointToLine, FindsTheSameToTheLastBitWithHelp) {
  const World room = slammot::testing::room();
  const auto surfels = surfels_of(room);
  const Pose2 truth{-2.0, 1.0, 0.6};
  const Pose2 prior = truth * Pose2{0.1, 0.1, -0.05};
  slammot::testing::HelpAtTheLastMoment help;
  const auto helped = PointToLineMatcher(&help).match(exact_scan_of(room, truth), surfels,
                                                      {prior, kVague}, prior, {});
  const auto alone = match_from(exact_scan_of(room, truth), surfels, prior);
  EXPECT_GT(help.shared(), 0);
  EXPECT_EQ(helped.map_from_base.pose, alone.map_from_base.pose);
  EXPECT_EQ(helped.map_from_base.covariance, alone.map_from_base.covariance);
}

TEST(PointToLine, FindsTheInverseWhenMapAndScanChangePlaces) {
  const World room = slammot::testing::room();
  const Pose2 b_from_a{0.15, -0.1, 0.04};
  const auto seen_from_a = exact_scan_of(room, {-1.0, 0.5, 0.2}, 1440);
  auto seen_from_b = seen_from_a;
  for (MatchPoint& point : seen_from_b) point.in_base_m = b_from_a * point.in_base_m;
  const auto map_of = [](const std::vector<MatchPoint>& points) {
    grids::SurfelMap surfels(grids::window_around({0.0, 0.0}, 60.0, kCell_m), 1000.0);
    for (const MatchPoint& point : points) surfels.add(point.in_base_m);
    return surfels;
  };
  const auto forward = match_from(seen_from_a, map_of(seen_from_b), {});
  const auto backward = match_from(seen_from_b, map_of(seen_from_a), {});
  EXPECT_THAT(forward.map_from_base.pose, PoseNear(b_from_a, 0.005));
  EXPECT_THAT(forward.map_from_base.pose * backward.map_from_base.pose, PoseNear(Pose2{}, 0.005));
}

TEST(PointToLine, MovesAndTurnsWithTheWorld) {
  const World room = slammot::testing::room();
  const Pose2 truth{-2.0, 1.0, 0.6};
  const auto points = exact_scan_of(room, truth);
  const Pose2 error{0.15, -0.1, 0.02};
  for (const Pose2& there_from_here :
       {Pose2{13.37, -4.2, 0.0}, {0.0, 0.0, 1.1}, {500.1, -300.7, -2.6}}) {
    const auto surfels =
        surfels_of(slammot::testing::moved(room, there_from_here), there_from_here.translation_m());
    const auto result = match_from(points, surfels, there_from_here * truth * error);
    EXPECT_THAT(result.map_from_base.pose, PoseNear(there_from_here * truth, 0.005));
  }
}

TEST(PointToLine, DoesNotCareAboutTheOrderOfThePoints) {
  const World room = slammot::testing::room();
  const auto surfels = surfels_of(room);
  auto points = exact_scan_of(room, {-2.0, 1.0, 0.6});
  const auto in_order = match_from(points, surfels, {-2.1, 1.1, 0.62});
  std::shuffle(points.begin(), points.end(), std::mt19937(1));
  EXPECT_THAT(match_from(points, surfels, {-2.1, 1.1, 0.62}).map_from_base.pose,
              PoseNear(in_order.map_from_base.pose, 1e-6));
}

/// The cost whose minimum is looked for, written down anew: Geman-McClure of the distances across
/// the surfaces.
double cost(const std::vector<MatchPoint>& points, const grids::SurfelMap& surfels,
            const UncertainPose2& prior, const Pose2& pose, const PointToLineConfig& config) {
  double sum = 0.0;
  for (const MatchPoint& point : points) {
    const Vector2 at_m = pose * point.in_base_m;
    const auto surfel = surfels.nearest(at_m, 1);
    if (!surfel || (at_m - surfel->mean_m).norm() > config.fine_gate_m) continue;
    const auto robust = [&](double residual_m, double variance_m2) {
      const double ratio2 = std::pow(residual_m / config.robust_scale_m, 2);
      return 0.5 * residual_m * residual_m / (1.0 + ratio2) / variance_m2;
    };
    if (surfel->normal.isZero()) {
      const double variance_m2 = std::pow(point.sigma_m + 0.5 * kCell_m, 2);
      sum += robust(at_m.x() - surfel->mean_m.x(), variance_m2) +
             robust(at_m.y() - surfel->mean_m.y(), variance_m2);
    } else {
      sum += robust(surfel->normal.dot(at_m - surfel->mean_m),
                    point.sigma_m * point.sigma_m + surfel->spread_m2);
    }
  }
  const Eigen::Vector3d off(pose.x_m - prior.pose.x_m, pose.y_m - prior.pose.y_m,
                            geometry::wrap_angle(pose.heading_rad - prior.pose.heading_rad));
  return config.information_share * sum + 0.5 * off.dot(prior.covariance.inverse() * off);
}

/// In a room, with a car 4 m ahead that has most of the beams that tell how far it is.
World with_car_at(double x_m) {
  return slammot::testing::joined(slammot::testing::room(30.0, 16.0), {{{x_m, -1.0}, {x_m, 1.0}}});
}

TEST(PointToLine, IsNotMovedByOneBodyThatHasMostOfTheBeams) {
  const auto surfels = surfels_of(with_car_at(4.0));
  auto points = exact_scan_of(with_car_at(4.03), {}, 720);
  std::erase_if(points, [beam = 0](const MatchPoint& point) mutable {  // it looks ahead, and the
                                                                       // walls are dark
    const bool is_of_car = point.in_base_m.x() < 4.1;
    return point.in_base_m.x() < 0.0 || (!is_of_car && beam++ % 4 != 0);
  });
  PointToLineConfig config;
  const double by_points_m = match_from(points, surfels, {}, config).map_from_base.pose.x_m;
  config.body_sigma_m = 0.15;
  const double by_bodies_m = match_from(points, surfels, {}, config).map_from_base.pose.x_m;
  EXPECT_LT(by_points_m, -0.018);
  EXPECT_GT(by_bodies_m, -0.015);
}

/// Between walls with a few shallow corners, and a car ahead.
World street_with_car_at(double x_m) {
  World street{{{x_m, -1.0}, {x_m, 1.0}}};
  for (const double side : {-1.0, 1.0}) {
    for (const double from_m : {0.0, 12.0}) {
      street.push_back({{from_m, side * 6.0}, {from_m + 6.0, side * 6.0}});
      street.push_back({{from_m + 6.0, side * 6.0}, {from_m + 6.0, side * 5.0}});
      street.push_back({{from_m + 6.0, side * 5.0}, {from_m + 12.0, side * 5.0}});
    }
  }
  return street;
}

TEST(PointToLine, CountsACornerOfALongWallLikeABodyThatIsSeenFromBehind) {
  const auto surfels = surfels_of(street_with_car_at(4.0));
  auto points = exact_scan_of(street_with_car_at(4.04), {}, 720);
  std::erase_if(points, [](const MatchPoint& point) { return point.in_base_m.x() < 0.5; });
  PointToLineConfig config;
  config.body_sigma_m = 0.15;
  EXPECT_GT(match_from(points, surfels, {}, config).map_from_base.pose.x_m, -0.02);
}

TEST(PointToLine, BelievesAScanAsMuchWithBodiesAsWithout) {
  const auto surfels = surfels_of(with_car_at(4.0));
  const auto points = exact_scan_of(with_car_at(4.0), {}, 720);
  PointToLineConfig config;
  config.unproven_share = 0.0;
  const auto position_information = [&] {
    return match_from(points, surfels, {}, config).scan_information.topLeftCorner<2, 2>().trace();
  };
  const double by_points = position_information();
  config.body_sigma_m = 0.15;
  EXPECT_NEAR(position_information() / by_points, 1.0, 0.1);
}

TEST(PointToLine, WeighsAllPointsOfASingleBodyAlike) {
  const auto surfels = surfels_of(slammot::testing::room());
  const auto points = exact_scan_of(slammot::testing::room(), {-2.0, 1.0, 0.6});
  const Pose2 guess{-2.1, 1.1, 0.62};
  PointToLineConfig config;
  const auto by_points = match_from(points, surfels, guess, config);
  config.body_sigma_m = 0.15;
  config.body_length_m = 0.001;  // each point is a body: none has more points than another
  EXPECT_THAT(match_from(points, surfels, guess, config).map_from_base.pose,
              PoseNear(by_points.map_from_base.pose, 0.002));
}

TEST(PointToLine, StopsWhereTheCostIsLeast) {
  std::mt19937 random(3);
  const World room = slammot::testing::room();
  const auto surfels = surfels_of(room);
  const PointToLineConfig config;
  const UncertainPose2 prior{{-2.02, 1.03, 0.61},
                             Eigen::Vector3d(0.0004, 0.0004, 0.0001).asDiagonal()};
  const auto points = points_seen(room, {-2.0, 1.0, 0.6}, 360, 0.02, random);
  const Pose2 found =
      PointToLineMatcher().match(points, surfels, prior, prior.pose, config).map_from_base.pose;
  const double least = cost(points, surfels, prior, found, config);
  for (const double sign : {-1.0, 1.0}) {
    for (const Eigen::Vector3d& step :
         {Eigen::Vector3d(0.004, 0, 0), {0, 0.004, 0}, {0, 0, 0.001}, {0.003, 0.003, 0.0005}}) {
      const Pose2 beside{found.x_m + sign * step.x(), found.y_m + sign * step.y(),
                         found.heading_rad + sign * step.z()};
      EXPECT_LT(least, cost(points, surfels, prior, beside, config));
    }
  }
}

TEST(PointToLine, TellsTheInformationOfTheNumericalJacobian) {
  const World room = slammot::testing::room();
  const auto surfels = surfels_of(room);
  const Pose2 truth{-2.0, 1.0, 0.6};
  const auto points = exact_scan_of(room, truth);
  PointToLineConfig config;
  config.robust_scale_m = 1e3;  // no weights to differentiate
  const auto result = match_from(points, surfels, truth, config);
  const Pose2& pose = result.map_from_base.pose;
  Matrix3 H = Matrix3::Zero();
  for (const MatchPoint& point : points) {
    const auto surfel = surfels.nearest(pose * point.in_base_m, 1);
    if (!surfel || surfel->normal.isZero() ||
        (pose * point.in_base_m - surfel->mean_m).norm() > config.fine_gate_m)
      continue;
    const auto residual_m = [&](const Pose2& at) {
      return surfel->normal.dot(at * point.in_base_m - surfel->mean_m);
    };
    constexpr double kStep = 1e-6;
    Eigen::Vector3d J;
    J << residual_m({pose.x_m + kStep, pose.y_m, pose.heading_rad}) -
             residual_m({pose.x_m - kStep, pose.y_m, pose.heading_rad}),
        residual_m({pose.x_m, pose.y_m + kStep, pose.heading_rad}) -
            residual_m({pose.x_m, pose.y_m - kStep, pose.heading_rad}),
        residual_m({pose.x_m, pose.y_m, pose.heading_rad + kStep}) -
            residual_m({pose.x_m, pose.y_m, pose.heading_rad - kStep});
    J /= 2.0 * kStep;
    H += J * J.transpose() / (point.sigma_m * point.sigma_m + surfel->spread_m2);
  }
  H *= config.information_share;
  // The few surfels without direction (corners) are not in H.
  EXPECT_LT((result.scan_information - H).norm(), 0.02 * H.norm());
}

TEST(PointToLine, IsAsUncertainAsItIsWrong) {
  std::mt19937 random(21);
  const World room = slammot::testing::room();
  const auto surfels = surfels_of(room);
  const Pose2 truth{-2.0, 1.0, 0.6};
  PointToLineConfig config;
  config.information_share = 1.0;  // the map is exact here, so the points of a scan err
                                   // independently
  config.robust_scale_m = 1.0;
  double nees_sum = 0.0;
  constexpr int kRuns = 200;
  for (int run = 0; run < kRuns; ++run) {
    const auto result =
        match_from(points_seen(room, truth, 180, 0.03, random), surfels, truth, config);
    const Pose2& pose = result.map_from_base.pose;
    const Eigen::Vector3d error(pose.x_m - truth.x_m, pose.y_m - truth.y_m,
                                pose.heading_rad - truth.heading_rad);
    nees_sum += error.dot(result.map_from_base.covariance.inverse() * error);
  }
  // 99 % band of the mean of chi-square with 3 degrees of freedom over 200 runs is 3 +- 0.45. Noise
  // along a slanting beam moves its point across the wall by less than sigma, so the truth may be a
  // little better than claimed.
  EXPECT_LT(nees_sum / kRuns, 3.45);
  EXPECT_GT(nees_sum / kRuns, 1.2);
}

TEST(PointToLine, LeavesThePriorAloneAlongAFeaturelessCorridor) {
  const World corridor = {{{-100.0, 1.5}, {100.0, 1.5}}, {{-100.0, -1.5}, {100.0, -1.5}}};
  const auto surfels = surfels_of(corridor);
  const Pose2 truth{0.0, 0.1, 0.0};
  auto points = exact_scan_of(corridor, truth);
  std::erase_if(points, [](const MatchPoint& point) { return point.in_base_m.norm() > 20.0; });
  const UncertainPose2 prior{{0.5, 0.2, 0.02}, Eigen::Vector3d(0.04, 0.04, 0.01).asDiagonal()};
  const auto result = PointToLineMatcher().match(points, surfels, prior, prior.pose, {});
  EXPECT_NEAR(result.map_from_base.pose.x_m, 0.5, 0.005);
  EXPECT_NEAR(result.map_from_base.pose.y_m, 0.1, 0.005);
  EXPECT_NEAR(result.map_from_base.pose.heading_rad, 0.0, 0.002);
  EXPECT_NEAR(result.map_from_base.covariance(0, 0), 0.04, 0.001);
  EXPECT_LT(result.map_from_base.covariance(1, 1), 0.0004);
}

TEST(PointToLine, IsNotPulledBackByPointsBeyondTheKnownEndOfAWall) {
  // The map knows the left wall up to x = 5; from farther on the scan sees it up to x = 8.
  const World known = {
      {{-5.0, 2.0}, {5.0, 2.0}}, {{-5.0, -2.0}, {8.0, -2.0}}, {{8.0, -2.0}, {8.0, 2.0}}};
  const World real = joined(known, {{{5.0, 2.0}, {8.0, 2.0}}});
  const Pose2 truth{1.0, 0.0, 0.0};
  const auto result =
      match_from(exact_scan_of(real, truth), surfels_of(known), truth * Pose2{0.1, 0.05, 0.01});
  EXPECT_THAT(result.map_from_base.pose, PoseNear(truth, 0.01));
}

TEST(PointToLine, IsNotPulledAwayByAFifthOfThePointsOnSomethingElse) {
  const World room = slammot::testing::room();
  const Pose2 truth{-2.0, 1.0, 0.6};
  auto points = exact_scan_of(room, truth);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i % 5 == 0) points[i].in_base_m *= 0.8 + 0.1 * std::sin(static_cast<double>(i));
  }
  EXPECT_THAT(
      match_from(points, surfels_of(room), truth * Pose2{0.1, 0.1, 0.02}).map_from_base.pose,
      PoseNear(truth, 0.01));
}

/// The vehicle has begun to turn, and far walls are off by decimetres though the prior is off by
/// less than three sigmas.
TEST(PointToLine, FollowsATurnThatThePriorAllowsForThoughFarWallsAreFarOff) {
  const World hall = slammot::testing::box({0.0, 0.0, 0.0}, 56.0, 50.0);
  const auto surfels = surfels_of(hall);
  const Pose2 truth{1.0, -2.0, 0.3};
  auto points = exact_scan_of(hall, truth, 60);
  for (MatchPoint& point : points) point.sigma_m = 0.05;
  const UncertainPose2 prior{truth * Pose2{0.0, 0.0, 0.0125},
                             Eigen::Vector3d(1e-4, 1e-4, 2.5e-5).asDiagonal()};
  const auto heading_error_rad = [&](double coarse_prior_sigmas) {
    const PointToLineConfig config{.coarse_prior_sigmas = coarse_prior_sigmas};
    const Pose2 found =
        PointToLineMatcher().match(points, surfels, prior, prior.pose, config).map_from_base.pose;
    return std::abs(geometry::wrap_angle(found.heading_rad - truth.heading_rad));
  };
  EXPECT_LT(heading_error_rad(2.0), 0.004);
  EXPECT_GT(heading_error_rad(0.0), 0.005);
}

/// Trunks of 0.3 m around the vehicle, as faces towards the places that they are seen from: the
/// points tell how far they are, and little of their directions.
World park() {
  World trunks;
  for (int i = 0; i < 9; ++i) {
    const Pose2 towards{0.0, 0.0, 0.7 * i};
    const double away_m = 6.0 + 1.1 * i;
    trunks.push_back({towards * Vector2(away_m, -0.15), towards * Vector2(away_m, 0.15)});
  }
  return trunks;
}

const Pose2 kTurned{0.0, 0.0, 0.012};

/// The points up to a range as those of objects of a width, of which both ends were seen.
std::vector<MatchPoint> seen_whole(std::vector<MatchPoint> points, double width_m,
                                   double up_to_m = 100.0) {
  for (MatchPoint& point : points)
    if (point.in_base_m.norm() < up_to_m) point.object_width_m = width_m, point.object_points = 3.0;
  return points;
}

TEST(PointToLine, FindsTheHeadingByTrunksThatWereSeenWhole) {
  const auto surfels = surfels_of(park(), {0.0, 0.0}, 0.5);
  const auto points = exact_scan_of(park(), {}, 720);
  const auto by_distances = match_from(points, surfels, kTurned);
  const auto whole = match_from(seen_whole(points, 0.3), surfels, kTurned);
  EXPECT_NEAR(whole.map_from_base.pose.heading_rad, 0.0, 0.001);
  EXPECT_GT(whole.scan_information(2, 2), 3.0 * by_distances.scan_information(2, 2));
}

TEST(PointToLine, UsesNoObjectsWhereWallsTellTheHeading) {
  const World in_a_hall = joined(park(), slammot::testing::box({}, 50.0, 40.0));
  const auto surfels = surfels_of(in_a_hall, {0.0, 0.0}, 0.5);
  const auto points = exact_scan_of(in_a_hall, {}, 720);
  const auto with_objects = seen_whole(points, 0.3, 16.0);
  const Pose2 by_walls = match_from(points, surfels, kTurned).map_from_base.pose;
  EXPECT_EQ(match_from(with_objects, surfels, kTurned).map_from_base.pose, by_walls);
  PointToLineConfig never_sure;
  never_sure.open_heading_rad = 1e-6;
  EXPECT_NE(match_from(with_objects, surfels, kTurned, never_sure).map_from_base.pose, by_walls);
}

TEST(PointToLine, UsesNoObjectsThatAreNotProvenOrTooWideOrFew) {
  const auto surfels = surfels_of(park(), {0.0, 0.0}, 0.5);
  grids::SurfelMap unproven(grids::window_around({0.0, 0.0}, 60.0, 0.5), 1000.0);
  for (const slammot::testing::Wall& trunk : park())
    for (int i = 0; i <= 15; ++i)
      unproven.add(trunk.from_m + (trunk.to_m - trunk.from_m) * i / 15.0, 7.0);
  const auto points = exact_scan_of(park(), {}, 720);
  const auto pose_of = [](const std::vector<MatchPoint>& matched, const grids::SurfelMap& map) {
    return match_from(matched, map, kTurned).map_from_base.pose;
  };
  const Pose2 by_distances = pose_of(points, surfels);
  EXPECT_EQ(pose_of(seen_whole(points, 0.3), unproven), pose_of(points, unproven));
  EXPECT_EQ(pose_of(seen_whole(points, 1.3), surfels), by_distances);
  EXPECT_EQ(pose_of(seen_whole(points, 0.3, 7.6), surfels), by_distances) << "two trunks";
  EXPECT_NE(pose_of(seen_whole(points, 0.3, 9.6), surfels), by_distances) << "four trunks";
}

TEST(PointToLine, TellsLessOfTheHeadingTheWiderTrunksAre) {
  const auto heading_information = [](double width_m) {
    World trunks = park();
    for (slammot::testing::Wall& trunk : trunks) {
      const Vector2 middle_m = 0.5 * (trunk.from_m + trunk.to_m);
      const Vector2 half_m = 0.5 * width_m * (trunk.to_m - trunk.from_m).normalized();
      trunk = {middle_m - half_m, middle_m + half_m};
    }
    const auto points = seen_whole(exact_scan_of(trunks, {}, 720), width_m);
    const auto found = match_from(points, surfels_of(trunks, {0.0, 0.0}, 0.5), {});
    return found.scan_information(2, 2) / found.matched_points;
  };
  EXPECT_GT(heading_information(0.3), 2.0 * heading_information(0.6));
}

TEST(PointToLine, IsNotHeldBackAlongAWallOfWhichPiecesAreSeenWhole) {
  // Through gaps pieces of a wall are seen that have the ends of the gaps, not their own.
  const World corridor = {{{-20.0, 1.5}, {20.0, 1.5}}, {{-20.0, -1.5}, {20.0, -1.5}}};
  const auto surfels = surfels_of(corridor, {0.0, 0.0}, 0.5);
  std::vector<MatchPoint> points;
  for (const double side : {-1.5, 1.5})
    for (const double gap_m : {-6.0, -2.0, 2.0, 6.0})
      for (int i = -5; i <= 5; ++i) points.push_back({{gap_m + 0.05 * i, side}, 0.03, 0.5, 11.0});
  const UncertainPose2 prior{{0.13, 0.05, 0.0}, Eigen::Vector3d(0.04, 0.04, 0.01).asDiagonal()};
  PointToLineConfig never_sure;
  never_sure.open_heading_rad = 1e-6;
  const auto found = PointToLineMatcher().match(points, surfels, prior, prior.pose, never_sure);
  EXPECT_NEAR(found.map_from_base.pose.x_m, 0.13, 1e-4);
  EXPECT_NEAR(found.map_from_base.pose.y_m, 0.0, 0.005);
}

TEST(PointToLine, GivesThePriorWhenNothingMatches) {
  const UncertainPose2 prior{{1.0, 2.0, 0.3}, kVague};
  const auto points = exact_scan_of(slammot::testing::room(), {});
  const grids::SurfelMap empty(grids::window_around({0.0, 0.0}, 20.0, kCell_m), 1000.0);
  const auto far_away = surfels_of(
      slammot::testing::moved(slammot::testing::room(), {25.0, 25.0, 0.0}), {30.0, 30.0});
  for (const auto* surfels : {&empty, &far_away}) {
    const auto result = PointToLineMatcher().match(points, *surfels, prior, {1.1, 2.1, 0.4}, {});
    EXPECT_EQ(result.map_from_base.pose, prior.pose);
    EXPECT_THAT(result.map_from_base.covariance, MatrixNear(prior.covariance, 1e-12));
    EXPECT_EQ(result.matched_points, 0);
    EXPECT_EQ(result.matched_share, 0.0);
    EXPECT_TRUE(result.scan_information.isZero());
  }
}

TEST(PointToLine, GivesThePriorForAScanWithoutPoints) {
  const UncertainPose2 prior{{1.0, 2.0, 0.3}, kVague};
  EXPECT_EQ(PointToLineMatcher()
                .match({}, surfels_of(slammot::testing::room()), prior, prior.pose, {})
                .map_from_base.pose,
            prior.pose);
}

TEST(PointToLine, WeighsPriorAndScanByTheirInformation) {
  const World room = slammot::testing::room();
  const auto surfels = surfels_of(room);
  const Pose2 truth{-2.0, 1.0, 0.6};
  const Pose2 prior = truth * Pose2{0.02, 0.0, 0.0};
  const auto points = exact_scan_of(room, truth);
  const auto error_m = [&](double prior_sigma_m) {
    const Matrix3 covariance =
        (Eigen::Vector3d(1.0, 1.0, 0.01) * prior_sigma_m * prior_sigma_m).asDiagonal();
    const auto result = PointToLineMatcher().match(points, surfels, {prior, covariance}, prior, {});
    return (result.map_from_base.pose.translation_m() - truth.translation_m()).norm();
  };
  EXPECT_NEAR(error_m(1e-5), 0.02, 1e-3);
  EXPECT_LT(error_m(0.1), 0.003);
  EXPECT_LT(error_m(0.003), error_m(0.001));
}

TEST(MatchPointToLine, IsNotHeldBackByWhatHasOnlyBeenSeenFromHere) {
  // A wall across the street that came along for the last half metre, as echoes of the ground do
  // when a vehicle brakes; the fronts of houses beside the street, seen for longer, say that the
  // vehicle has moved on by 4 cm.
  grids::SurfelMap surfels(grids::window_around({0.0, 0.0}, 60.0, kCell_m), 1000.0);
  std::vector<MatchPoint> points;
  for (const double x_m : {6.1, 12.1}) {
    for (double y_m = 5.0; y_m < 7.0; y_m += 0.1) {
      for (const double side : {-1.0, 1.0}) {
        for (const double odometer_m : {1.0, 4.0}) surfels.add({x_m, side * y_m}, odometer_m);
        points.push_back({{x_m - 0.04, side * y_m}, 0.03});
      }
    }
  }
  for (double y_m = -4.0; y_m < 4.0; y_m += 0.1) {
    for (const double odometer_m : {3.5, 4.0}) surfels.add({20.1, y_m}, odometer_m);
    points.push_back({{20.1, y_m}, 0.03});
  }
  const auto result = match_from(points, surfels, Pose2{});
  EXPECT_NEAR(result.map_from_base.pose.x_m, 0.04, 0.004);
  EXPECT_NEAR(result.new_share, 0.5, 0.02);  // the wall has as many points as the fronts
  PointToLineConfig believes_all;
  believes_all.unproven_share = 1.0;
  EXPECT_LT(match_from(points, surfels, Pose2{}, believes_all).map_from_base.pose.x_m, 0.025);
}

}  // namespace
}  // namespace slammot::matching
