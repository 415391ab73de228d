#include "common/matching/odometry_check.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

namespace slammot::matching {
namespace {

using geometry::Pose2;
using std::numbers::pi;

constexpr double kMetres = 1.0;  // per unit of the positions

TEST(OdometryCheck, TellsDegreesFromRadians) {
  OdometryCheck radians;
  OdometryCheck degrees;
  for (int i = 0; i < 40; ++i) {
    const double heading_rad = 0.2 * i;  // unwrapped: more than a turn
    const Pose2 pose{std::sin(heading_rad), -std::cos(heading_rad), heading_rad};
    radians.add(pose);
    degrees.add({pose.x_m, pose.y_m, heading_rad * 180.0 / pi});
  }
  EXPECT_FALSE(radians.is_in_degrees());
  EXPECT_FALSE(radians.positions_are_mirrored());
  EXPECT_TRUE(degrees.is_in_degrees());
}

/// Forty equal steps, with sound turns and with the wrong sign.
std::pair<OdometryCheck, OdometryCheck> turning_by_steps(const Pose2& step) {
  OdometryCheck sound;
  OdometryCheck mirrored;
  Pose2 pose;
  Pose2 other;
  for (int i = 0; i < 40; ++i) {
    sound.add(pose);
    mirrored.add(other);
    pose = pose * step;
    other = other * Pose2{step.x_m, step.y_m, -step.heading_rad};
  }
  return {sound, mirrored};
}

TEST(OdometryCheck, SeesHeadingsThatTurnAgainstTheirArcs) {
  const auto [sound, mirrored] = turning_by_steps({0.2, 0.2 * 0.05, 0.1});
  EXPECT_FALSE(sound.turns_against_its_arcs(kMetres));
  EXPECT_TRUE(sound.turns_with_its_arcs(kMetres));
  EXPECT_TRUE(mirrored.turns_against_its_arcs(kMetres));
  EXPECT_FALSE(mirrored.turns_with_its_arcs(kMetres));
}

TEST(OdometryCheck, SeesArcsAlsoWherePositionsAreLate) {
  // along the heading of one and a half steps ago
  const auto [sound, mirrored] = turning_by_steps({0.2, -0.2 * 0.1, 0.1});
  EXPECT_TRUE(sound.turns_with_its_arcs(kMetres));
  EXPECT_FALSE(sound.turns_against_its_arcs(kMetres));
  EXPECT_TRUE(mirrored.turns_against_its_arcs(kMetres));
  EXPECT_FALSE(mirrored.turns_with_its_arcs(kMetres));
}

/// Poses of a point of a car ahead of its rear axle, at changing speed, once with sound turns and
/// once with the wrong sign.
struct CentresOfACar {
  explicit CentresOfACar(double unit = 1.0) {
    Pose2 pose;
    Pose2 other;
    for (int i = 0; i < 200; ++i) {
      sound.add(pose);
      mirrored.add(other);
      const double way = (0.05 + 0.3 * (i % 20) / 20.0) * unit;
      const double turn_rad = 0.02 * std::sin(0.1 * i);
      const double slip = -4.0 / unit * way * way * turn_rad;  // tails swing out with speed
      const double sideways = (1.3 * unit + 0.5 * way) * turn_rad + slip;
      pose = pose * Pose2{way, sideways, turn_rad};
      other = other * Pose2{way, sideways, -turn_rad};
    }
  }
  OdometryCheck sound;
  OdometryCheck mirrored;
};

TEST(OdometryCheck, TellsTurnsWithTheWrongSignByThePointAheadOfTheAxle) {
  const CentresOfACar car;
  EXPECT_TRUE(car.sound.turns_with_its_arcs(kMetres));
  EXPECT_FALSE(car.sound.turns_against_its_arcs(kMetres));
  EXPECT_TRUE(car.mirrored.turns_against_its_arcs(kMetres));
  EXPECT_FALSE(car.mirrored.turns_with_its_arcs(kMetres));
}

TEST(OdometryCheck, KnowsThePointAheadOfTheAxleInMillimetresToo) {
  const CentresOfACar car(1000.0);
  EXPECT_TRUE(car.sound.turns_with_its_arcs(1e-3));
  EXPECT_TRUE(car.mirrored.turns_against_its_arcs(1e-3));
}

TEST(OdometryCheck, SeesSwappedAxesOnStreetsThatCrossAtRightAngles) {
  OdometryCheck sound;
  OdometryCheck swapped;
  Pose2 pose;
  for (int i = 0; i < 400; ++i) {
    sound.add(pose);
    swapped.add({pose.y_m, pose.x_m, pose.heading_rad});
    const bool turns = i % 50 >= 45;
    const double turn_rad = turns ? 0.1 * std::numbers::pi : 0.0;
    pose = pose * Pose2{1.0, 0.5 * turn_rad, turn_rad};
  }
  EXPECT_FALSE(sound.positions_are_mirrored());
  EXPECT_TRUE(swapped.positions_are_mirrored());
}

}  // namespace
}  // namespace slammot::matching
