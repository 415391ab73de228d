#include "services/collision_warning/collision_monitor.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/services/collision_warning/situation.hpp"

namespace slammot::collision_warning {
namespace {

using flow::WarningLevel;

constexpr double kPeriodS = 0.027;

/// Highest level while both drive for so long.
WarningLevel highest_level(double speed_mps, const RoadUser& other, double duration_s) {
  CollisionMonitor monitor{CollisionWarningConfig{}};
  auto highest = WarningLevel::kNone;
  for (double t = 0.0; t < duration_s; t += kPeriodS)
    highest = std::max(highest, monitor.step(tracked_at(t, speed_mps, other)).highest_level);
  return highest;
}

/// Time of the first warning.
std::optional<double> first_warning_s(double speed_mps, const RoadUser& other, double duration_s) {
  CollisionMonitor monitor{CollisionWarningConfig{}};
  for (double t = 0.0; t < duration_s; t += kPeriodS) {
    if (monitor.step(tracked_at(t, speed_mps, other)).highest_level == WarningLevel::kWarning)
      return t;
  }
  return std::nullopt;
}

TEST(CollisionMonitor, WarnsTwoSecondsBeforeACarThatStands) {
  const double contact_s = (60.0 - 0.5 * (5.0 + 4.4)) / 10.0;
  const auto warned_s = first_warning_s(10.0, {{60.0, 0.0}, {0.01, 0.0}}, contact_s);
  ASSERT_TRUE(warned_s);
  EXPECT_LE(*warned_s, contact_s - 2.0);
  EXPECT_GE(*warned_s, contact_s - 4.0);
}

TEST(CollisionMonitor, WarnsOfACrossingCarThatDoesNotYield) {
  const auto warned_s = first_warning_s(8.0, {{48.0, -48.0}, {0.0, 8.0}}, 5.5);
  ASSERT_TRUE(warned_s);
  EXPECT_LE(*warned_s, 5.4 - 2.0);
}

TEST(CollisionMonitor, WarnsOfAPedestrianInTheWay) {
  const auto warned_s = first_warning_s(8.0, {{48.0, -8.6}, {0.0, 1.5}, 0.5, 0.5}, 5.6);
  ASSERT_TRUE(warned_s);
  EXPECT_LE(*warned_s, 5.6 - 2.0);
}

TEST(CollisionMonitor, DoesNotWarnOfOncomingTraffic) {
  EXPECT_LT(highest_level(10.0, {{120.0, 3.5}, {-10.0, 0.0}}, 7.0), WarningLevel::kWarning);
}

TEST(CollisionMonitor, DoesNotWarnOfACarThatLeads) {
  EXPECT_LT(highest_level(10.0, {{15.0, 0.0}, {10.0, 0.0}}, 5.0), WarningLevel::kWarning);
}

TEST(CollisionMonitor, DoesNotWarnOfACarBesideTheVehicle) {
  EXPECT_LT(highest_level(10.0, {{2.0, 3.2}, {10.5, 0.0}}, 5.0), WarningLevel::kWarning);
}

TEST(CollisionMonitor, DoesNotWarnOfWhatStandsBesideTheRoad) {
  EXPECT_LT(highest_level(12.0, {{60.0, -3.5}, {0.0, 0.0}}, 6.0), WarningLevel::kWarning);
}

TEST(CollisionMonitor, DoesNotWarnOfACarThatHasCrossed) {
  EXPECT_LT(highest_level(8.0, {{48.0, 4.0}, {0.0, 8.0}}, 5.5), WarningLevel::kWarning);
}

TEST(CollisionMonitor, DoesNotWarnWhileTheVehicleStands) {
  EXPECT_EQ(highest_level(0.0, {{20.0, 0.0}, {-6.0, 0.0}}, 3.0), WarningLevel::kNone);
}

TEST(CollisionMonitor, WarnsOfACarThatChangesIntoTheLane) {
  const double contact_s = (19.0 - 0.5 * (5.0 + 4.4)) / 4.5;
  const auto warned_s = first_warning_s(10.5, {{19.0, 2.5}, {6.0, -1.0}}, contact_s);
  ASSERT_TRUE(warned_s);
  EXPECT_LE(*warned_s, contact_s - 2.0);
}

TEST(CollisionMonitor, LeavesWhatIsBehindOut) {
  CollisionMonitor monitor{CollisionWarningConfig{}};
  for (double t = 0.0; t < 2.0; t += kPeriodS)
    EXPECT_TRUE(monitor.step(tracked_at(t, 5.0, {{-60.0, 0.0}, {20.0, 0.0}})).objects.empty());
}

TEST(CollisionMonitor, LeavesOccludedTracksOut) {
  CollisionMonitor monitor{CollisionWarningConfig{}};
  flow::TrackedObjects tracked = tracked_at(0.0, 8.0, {{10.0, 0.0}, {0.0, 0.0}});
  EXPECT_EQ(monitor.step(tracked).objects.size(), 1U);
  tracked.objects.front().occluded = true;
  EXPECT_TRUE(monitor.step(tracked).objects.empty());
}

TEST(CollisionMonitor, LeavesTentativeTracksOut) {
  CollisionMonitor monitor{CollisionWarningConfig{}};
  flow::TrackedObjects tracked = tracked_at(0.0, 8.0, {{10.0, 0.0}, {0.0, 0.0}});
  tracked.objects.front().confirmed = false;
  EXPECT_TRUE(monitor.step(tracked).objects.empty());
}

TEST(CollisionMonitor, BeginsAnewInAnotherDrive) {
  CollisionMonitor monitor{CollisionWarningConfig{}};
  const RoadUser in_the_way{{14.0, 0.0}, {0.0, 0.0}};
  flow::CollisionWarnings warnings;
  for (double t = 0.0; t < 0.5; t += kPeriodS)
    warnings = monitor.step(tracked_at(t, 8.0, in_the_way));
  ASSERT_EQ(warnings.highest_level, WarningLevel::kWarning);
  flow::TrackedObjects other_drive = tracked_at(0.6, 8.0, in_the_way);
  other_drive.odom_id = {2};
  EXPECT_EQ(monitor.step(other_drive).highest_level, WarningLevel::kNone);
  EXPECT_EQ(monitor.vehicle().speed_mps, 0.0);
}

TEST(CollisionMonitor, IsTheSameInAnotherFrame) {
  const geometry::Pose2 other_from_odom{300.0, -20.0, 2.0};
  CollisionMonitor monitor{CollisionWarningConfig{}};
  CollisionMonitor turned{CollisionWarningConfig{}};
  const Eigen::Matrix2d turn = geometry::rotation(other_from_odom.heading_rad);
  for (double t = 0.0; t < 3.0; t += kPeriodS) {
    flow::TrackedObjects tracked = tracked_at(t, 8.0, {{40.0, -8.0}, {0.0, 1.6}, 0.5, 0.5});
    const flow::CollisionWarning here = monitor.step(tracked).objects.at(0);
    flow::TrackedObject& object = tracked.objects.front();
    object.position_in_odom_m = other_from_odom * object.position_in_odom_m;
    object.velocity_in_odom_mps = turn * object.velocity_in_odom_mps;
    object.heading_in_odom_rad += other_from_odom.heading_rad;
    tracked.odom_from_base = other_from_odom * tracked.odom_from_base;
    const flow::CollisionWarning there = turned.step(tracked).objects.at(0);
    EXPECT_NEAR(here.closest_distance_m, there.closest_distance_m, 1e-6);
    EXPECT_NEAR(here.probability, there.probability, 0.1);
  }
}

}  // namespace
}  // namespace slammot::collision_warning
