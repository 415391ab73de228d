#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/localization/localizer.hpp"
#include "tests/support/localizer_drive.hpp"
#include "tests/support/matchers.hpp"

namespace slammot::localization {
namespace {

using geometry::Pose2;
using slammot::testing::arc;
using slammot::testing::drive_one;
using slammot::testing::drive_through;
using slammot::testing::DriveSetup;
using slammot::testing::PoseNear;
using slammot::testing::SimulatedDrive;
using slammot::testing::small_map_config;

constexpr std::uint32_t kCarriedAt = 330;  // it has seen all of the room by then

/// A robot that goes round in a room and is carried away after once around; its wheels do not turn
/// meanwhile.
DriveSetup carried_away(const Pose2& before_from_after,
                        const slammot::testing::World& world = slammot::testing::room()) {
  DriveSetup setup{.world = world};
  const auto path = arc({0.0, -3.0, 0.0}, 0.5, 0.2);
  const double carried_s = 0.1 * kCarriedAt - 0.05;
  setup.world_from_base_at = [=](double time_s) {
    const Pose2 there = path(carried_s);
    return time_s < carried_s ? path(time_s)
                              : there * before_from_after * (inverse(there) * path(time_s));
  };
  return setup;
}

/// What the wheels would have said had it not been carried.
sensing::Odometry odometry(SimulatedDrive& not_carried, std::uint32_t scan) {
  return not_carried.odometry(scan);
}

/// Wheels are not trusted for a moment, as those of a robot that is carried about.
LocalizerConfig without_patience() {
  LocalizerConfig config = small_map_config();
  config.recovery.lost_after_s = 0.0;
  config.odometry.may_be_picked_up = true;
  return config;
}

class Recovery : public ::testing::Test {
 protected:
  void drive(const DriveSetup& setup, std::uint32_t first, std::uint32_t last,
             bool with_odometry = true) {
    SimulatedDrive carried(setup);
    for (std::uint32_t scan = first; scan < last; ++scan) {
      if (with_odometry) localizer_.add_odometry(odometry(wheels_, scan));
      scans_.push_back(*localizer_.localize(carried.scan(scan)));
      localizer_.integrate(slammot::testing::all_stationary(scans_.back()));
    }
  }
  const Pose2& newest() const { return scans_.back().odom_from_base.pose; }
  const LocalizerCounters& counters() const { return localizer_.counters(); }

  SimulatedDrive wheels_{carried_away({})};
  Localizer localizer_{without_patience()};
  std::vector<flow::LocalizedScan> scans_;
};

TEST_F(Recovery, FindsItselfInTheLocalMapWhereverItWasCarried) {
  for (const Pose2& carried :
       {Pose2{1.5, 0.0, 0.0}, Pose2{3.0, 1.0, 0.7}, Pose2{0.0, 0.0, std::numbers::pi}}) {
    const DriveSetup setup = carried_away(carried);
    localizer_ = Localizer(without_patience());
    wheels_ = SimulatedDrive(carried_away({}));
    drive(setup, 0, kCarriedAt + 60);
    EXPECT_THAT(newest(), PoseNear(SimulatedDrive(setup).odom_from_base(kCarriedAt + 59), 0.05))
        << carried.x_m << " " << carried.y_m << " " << carried.heading_rad;
    EXPECT_GE(counters().matches.found_again, 1U);
    EXPECT_EQ(counters().map.astray, 0U);
  }
}

TEST_F(Recovery, KeepsTheMapCleanWhileItIsLost) {
  const DriveSetup setup = carried_away({3.0, 1.0, 0.7});
  drive(setup, 0, kCarriedAt + 60);
  EXPECT_GT(counters().map.withheld_scans, 0U);
  int smeared = 0;
  const auto& surfels = localizer_.local_map().surfels();
  const Pose2 world_from_odom = SimulatedDrive(setup).setup().world_from_base_at(0.0);
  for (const auto& surfel : surfels.all()) {
    double nearest_m = 1e9;
    const geometry::Vector2 at_m = world_from_odom * surfel.mean_m;
    for (const auto& wall : setup.world) {
      const geometry::Vector2 along_m = wall.to_m - wall.from_m;
      const double share =
          std::clamp((at_m - wall.from_m).dot(along_m) / along_m.squaredNorm(), 0.0, 1.0);
      nearest_m = std::min(nearest_m, (wall.from_m + share * along_m - at_m).norm());
    }
    if (nearest_m > 0.25) ++smeared;
  }
  EXPECT_EQ(smeared, 0);
}

TEST_F(Recovery, BeginsAMapTiedByNextToNothingWhereItKnowsNothing) {
  const DriveSetup elsewhere =
      carried_away({300.0, 0.0, 0.0},
                   slammot::testing::joined(
                       slammot::testing::room(),
                       slammot::testing::moved(
                           slammot::testing::polygon(
                               {{-6.0, -4.0}, {7.0, -5.0}, {5.0, 6.0}, {0.0, 3.0}, {-7.0, 5.0}}),
                           carried_away({300.0, 0.0, 0.0}).world_from_base_at(35.0))));
  drive(elsewhere, 0, kCarriedAt + 100);
  EXPECT_EQ(counters().map.astray, 1U);
  const auto first = localizer_.take_finished_submap();
  ASSERT_TRUE(first);
  localizer_.finish();
  const auto second = localizer_.take_finished_submap();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->submap_id.value, first->submap_id.value + 1);
  EXPECT_GE(std::sqrt(second->previous_from_submap.covariance(0, 0)), 49.0);
  EXPECT_GE(std::sqrt(second->previous_from_submap.covariance(2, 2)), 3.0);
  // From there on the motion is right again.
  SimulatedDrive truth(elsewhere);
  const auto step = [](const Pose2& from, const Pose2& to) { return inverse(from) * to; };
  EXPECT_THAT(
      step(scans_[kCarriedAt + 70].odom_from_base.pose, newest()),
      PoseNear(step(truth.odom_from_base(kCarriedAt + 70), truth.odom_from_base(kCarriedAt + 99)),
               0.05));
}

TEST_F(Recovery, IsNotLostInADriveLikeAnyOther) {
  drive(carried_away({}), 0, kCarriedAt + 20);
  EXPECT_EQ(counters().matches.found_again + counters().map.astray + counters().map.withheld_scans,
            0U);
}

TEST_F(Recovery, ComesBackAfterAMinuteInTheDark) {
  DriveSetup setup = carried_away({});
  setup.wheels = {.scale = 1.03, .heading_rate_bias_radps = 0.01};
  SimulatedDrive drive(setup);
  drive_through(localizer_, drive, 0, kCarriedAt);
  for (std::uint32_t scan = kCarriedAt; scan < kCarriedAt + 600; ++scan) {
    localizer_.add_odometry(drive.odometry(scan));
    auto blinded = drive.scan(scan);
    std::fill(blinded.range_m.begin(), blinded.range_m.end(),
              static_cast<float>(blinded.scanner.max_range_m));
    localizer_.localize(blinded);
  }
  drive_through(localizer_, drive, kCarriedAt + 600, kCarriedAt + 610);
  EXPECT_LT(drive_through(localizer_, drive, kCarriedAt + 610, kCarriedAt + 650).worst_m, 0.15);
}

}  // namespace
}  // namespace slammot::localization
