#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "common/config/profiles.hpp"
#include "services/slammot/pipeline.hpp"
#include "services/slammot/stored_map.hpp"
#include "tests/support/example_submap.hpp"
#include "tests/support/localizer_drive.hpp"
#include "tests/support/temporary_folder.hpp"

namespace slammot {
namespace {

using geometry::Pose2;
using slammot::testing::box;
using slammot::testing::DriveSetup;
using slammot::testing::joined;
using slammot::testing::SimulatedDrive;
using slammot::testing::World;

constexpr double kSpeed_mps = 1.0;
constexpr double kSide_m = 24.0;  // side of the square path

/// A ring of corridors of four widths around a block, with pillars that make every place unique.
World corridors() {
  World world = joined(box({12.3, 11.8, 0.0}, 21.4, 21.8), box({12.75, 13.4, 0.0}, 28.5, 29.2));
  const std::vector<Pose2> pillars{{5.0, -0.9, 0.1},  {8.0, 0.9, 0.0},   {15.5, -1.0, 0.5},
                                   {24.9, 3.0, 0.2},  {23.1, 9.5, 0.0},  {24.8, 17.0, 0.9},
                                   {19.0, 24.9, 0.3}, {11.0, 23.1, 0.0}, {9.5, 24.9, 0.7},
                                   {-0.9, 21.0, 0.0}, {0.9, 13.0, 0.4},  {-0.8, 6.5, 0.1}};
  double size_m = 0.3;
  for (const Pose2& pillar : pillars) world = joined(world, box(pillar, size_m += 0.05, 0.4));
  return world;
}

/// Pose on the square path with rounded corners.
Pose2 around(double time_s) {
  constexpr double kRadius_m = 1.0;
  constexpr double kStraight_m = kSide_m - 2.0 * kRadius_m;
  constexpr double kArc_m = 0.5 * std::numbers::pi * kRadius_m;
  const double way_m = kSpeed_mps * time_s;
  const double side = std::floor(way_m / (kStraight_m + kArc_m));
  const double on_m = way_m - side * (kStraight_m + kArc_m);
  const Pose2 start{kRadius_m, 0.0, 0.0};
  const Pose2 quarter_turn = Pose2{12.0, 12.0, 0.0} *
                             Pose2{0.0, 0.0, 0.5 * std::numbers::pi * side} *
                             Pose2{-12.0, -12.0, 0.0};
  const double turned_rad = std::max(0.0, on_m - kStraight_m) / kRadius_m;
  return quarter_turn * start * Pose2{std::min(on_m, kStraight_m), 0.0, 0.0} *
         Pose2{kRadius_m * std::sin(turned_rad), kRadius_m * (1.0 - std::cos(turned_rad)),
               turned_rad};
}

Profile indoor() {
  Profile profile;
  const auto stages = bind_stages(profile);
  EXPECT_FALSE(config::overlay_file(*config::find_profile("indoor"), stages));
  return profile;
}

/// Ten scans a second, from first_s of the path on; odometry does not move while the robot is
/// carried.
struct Drive {
  double first_s = 0.0;
  double last_s = 0.0;
  double carried_at_s = 1e9;
  double carried_by_s = 0.0;  ///< Along the path.
  double gap_s = 0.0;         ///< Gap in the stamps while it was carried.

  Pose2 world_from_base(double time_s) const {
    return around(time_s < carried_at_s ? time_s : time_s + carried_by_s);
  }

  void through(Pipeline& pipeline) const {
    const SimulatedDrive robot({.world = corridors(), .world_from_base_at = [this](double time_s) {
                                  return world_from_base(time_s);
                                }});
    Pose2 wheel_from_base;
    for (auto scan = static_cast<std::uint32_t>(10.0 * first_s);
         scan < static_cast<std::uint32_t>(10.0 * last_s); ++scan) {
      const bool is_carried =
          robot.time_s(scan) >= carried_at_s && robot.time_s(scan) - 0.1 < carried_at_s;
      if (!is_carried)
        wheel_from_base = wheel_from_base * (inverse(world_from_base(robot.time_s(scan) - 0.1)) *
                                             world_from_base(robot.time_s(scan)));
      sensing::LaserScan measured = robot.scan(scan);
      measured.stamp_ns +=
          robot.time_s(scan) < carried_at_s ? 0 : slammot::testing::stamp_ns_of(gap_s);
      pipeline.take(sensing::Odometry{measured.stamp_ns, wheel_from_base});
      pipeline.take(measured);
    }
    pipeline.finish();
  }

  /// Greatest position error of the last ten seconds of the corrected trajectory, in the frame of a
  /// map whose origin is at world_from_map.
  double worst_at_end_m(const Pipeline& pipeline, const Pose2& world_from_map) const {
    const auto trajectory = pipeline.record().corrected_trajectory();
    double worst_m = 0.0;
    for (std::size_t back = 1; back <= 100; ++back) {
      const Pose2 truth =
          inverse(world_from_map) * world_from_base(last_s - 0.1 * static_cast<double>(back));
      worst_m =
          std::max(worst_m, (trajectory[trajectory.size() - back].map_from_base.translation_m() -
                             truth.translation_m())
                                .norm());
    }
    return worst_m;
  }
};

TEST(Relocalization, LocatesARobotCarriedWithItsScannerOff) {
  const Drive drive{.last_s = 190.0, .carried_at_s = 110.0, .carried_by_s = 35.0, .gap_s = 30.0};
  Pipeline pipeline(indoor());
  drive.through(pipeline);
  EXPECT_TRUE(pipeline.is_connected());
  EXPECT_GT(pipeline.accepted_closures(), 0U);
  EXPECT_LT(drive.worst_at_end_m(pipeline, around(0.0)), 0.3);
}

TEST(Relocalization, LocatesARobotCarriedBetweenTwoScans) {
  const Drive drive{.last_s = 190.0, .carried_at_s = 110.0, .carried_by_s = 35.0};
  Pipeline pipeline(indoor());
  drive.through(pipeline);
  EXPECT_TRUE(pipeline.is_connected());
  EXPECT_LT(drive.worst_at_end_m(pipeline, around(0.0)), 0.3);
}

TEST(Relocalization, ContinuesAStoredMapFromAnyPlaceInIt) {
  const slammot::testing::TemporaryFolder folder;
  Pipeline first(indoor());
  Drive{.last_s = 110.0}.through(first);
  ASSERT_FALSE(write_stored_map(folder.path(), first.record().submaps()));
  const auto stored = read_stored_map(folder.path(), indoor().localization.map.cell_size_m);
  ASSERT_TRUE(stored);

  const Drive second{.first_s = 40.0, .last_s = 100.0};
  Pipeline pipeline(indoor());
  pipeline.continue_map(*stored);
  second.through(pipeline);
  EXPECT_TRUE(pipeline.is_connected());
  EXPECT_LT(second.worst_at_end_m(pipeline, around(0.0)), 0.3);
  EXPECT_GT(pipeline.record().submaps().size(), stored->size());  // one map of both drives, for the
                                                                  // third
}

TEST(Relocalization, RejectsAMapOfAnotherProfile) {
  const slammot::testing::TemporaryFolder folder;
  flow::Submap submap = slammot::testing::example_submap(0);
  submap.cell_size_m = 0.2;
  ASSERT_FALSE(write_stored_map(folder.path(), {submap}, "robot"));
  EXPECT_TRUE(read_stored_map(folder.path(), 0.2));
  const auto refused = read_stored_map(folder.path(), 0.05);
  ASSERT_FALSE(refused);
  EXPECT_NE(
      refused.error().message.find("of another profile, with cells of 0.2 m instead of 0.05 m"),
      std::string::npos)
      << refused.error().message;
}

}  // namespace
}  // namespace slammot
