#include "services/tracking/road_users.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace slammot::tracking {
namespace {

constexpr std::size_t kCar = 1;
constexpr std::size_t kTruck = 2;
constexpr double kErrorM2 = 0.004;

/// Lengths of cars, this far apart on either side of 4.5 m.
RoadUsersSeen cars_seen(int count, double off_m) {
  RoadUsersSeen seen;
  for (int i = 0; i < count; ++i)
    seen.add_length(Kind::kCar, {4.5 + (i % 2 == 0 ? off_m : -off_m), kErrorM2});
  return seen;
}

TEST(RoadUsers, AreThoseAnywhereUntilSomeWereSeen) {
  const RoadUsers known = RoadUsersSeen().known();
  for (std::size_t i = 0; i < kKinds.size(); ++i) {
    EXPECT_NEAR(known.kinds[i].length_m, kKinds[i].length_m, 1e-9);
    EXPECT_NEAR(known.kinds[i].length_sigma_m, kKinds[i].length_sigma_m, 1e-9);
    EXPECT_NEAR(known.kinds[i].width_sigma_m, kKinds[i].width_sigma_m, 1e-9);
    EXPECT_NEAR(known.kinds[i].share + known.kinds[kKinds.size() + i].share, kKinds[i].share, 1e-9);
  }
  EXPECT_NEAR(known.corner.variance_m2, kCorner.variance_m2, 1e-9);
}

TEST(RoadUsers, AreAsAlikeAsThoseSeen) {
  EXPECT_NEAR(cars_seen(40, 0.0).known().kinds[kCar].length_m, 4.5, 0.02);
  EXPECT_LT(cars_seen(40, 0.0).known().kinds[kCar].length_sigma_m, 0.1);
  EXPECT_NEAR(cars_seen(40, 0.3).known().kinds[kCar].length_sigma_m, 0.3, 0.05);
  EXPECT_GT(cars_seen(2, 0.0).known().kinds[kCar].length_sigma_m, 0.2) << "two tell little";
}

TEST(RoadUsers, DifferByLessThanTheyAreMeasuredTo) {
  EXPECT_LT(cars_seen(40, std::sqrt(kErrorM2)).known().kinds[kCar].length_sigma_m, 0.05);
}

TEST(RoadUsers, AreAlikeWhereOthersAre) {
  const auto with_a_truck = [](RoadUsersSeen seen) {
    seen.add_length(Kind::kTruck, {7.4, kErrorM2});
    return seen.known().kinds[kTruck];
  };
  EXPECT_NEAR(with_a_truck(cars_seen(40, 0.0)).length_m, 7.4, 0.1);
  EXPECT_LT(with_a_truck(cars_seen(40, 0.0)).length_sigma_m,
            0.6 * with_a_truck(cars_seen(40, 0.4)).length_sigma_m);
}

TEST(RoadUsers, MayBeAsThoseAnywhereAllTheSame) {
  const RoadUsers known = cars_seen(40, 0.0).known();
  EXPECT_GT(known.kinds[kKinds.size() + kCar].share, 0.0);
  EXPECT_EQ(known.kinds[kKinds.size() + kCar].length_sigma_m, kKinds[kCar].length_sigma_m);
}

TEST(RoadUsers, HaveCornersAsRoundAsThoseSeen) {
  RoadUsersSeen seen;
  for (int i = 0; i < 10; ++i) seen.add_corner({0.02, 0.0004});
  EXPECT_NEAR(seen.known().corner.value_m, 0.02, 0.02);
  EXPECT_LT(seen.known().corner.variance_m2, 0.5 * kCorner.variance_m2);
}

RoadUsersSeen bodies_seen(int count, double off_sides_share) {
  RoadUsersSeen seen;
  for (int i = 0; i < count; ++i) seen.add_off_sides_share(off_sides_share);
  return seen;
}

TEST(RoadUsers, AreAsNearToBoxesAsEchoesLieToTheirSides) {
  EXPECT_NEAR(RoadUsersSeen().known().shape_share, 1.0, 1e-9);
  EXPECT_NEAR(bodies_seen(20, 0.75).known().shape_share, 1.0, 1e-9) << "as is taken";
  EXPECT_NEAR(bodies_seen(20, 0.5).known().shape_share, 0.5, 0.06);
  EXPECT_GT(bodies_seen(1, 0.3).known().shape_share, 0.6) << "one tells little";
}

TEST(RoadUsers, AreNeitherTakenForExactNorForWorseThanTheSettingsSay) {
  EXPECT_NEAR(bodies_seen(50, 0.0).known().shape_share, 1.0 / 3.0, 1e-9);
  EXPECT_NEAR(bodies_seen(50, 1.8).known().shape_share, 1.0, 1e-9);
}

TEST(RoadUsers, SwingAsTheyWereSeenToAndNoMoreThanTheSettingsSay) {
  const auto known_of = [](int count, double share) {
    RoadUsersSeen seen;
    for (int i = 0; i < count; ++i) seen.add_swing_share(share);
    return seen.known().swing_share;
  };
  EXPECT_EQ(known_of(0, 0.0), 1.0);
  EXPECT_NEAR(known_of(2, 0.25), 0.625, 1e-9) << "as much as the settings count";
  EXPECT_NEAR(known_of(50, 0.25), 0.25, 0.05);
  EXPECT_EQ(known_of(50, 3.0), 1.0);
}

}  // namespace
}  // namespace slammot::tracking
