#include "examples/icp_localizer/icp_localizer.hpp"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/localizer_drive.hpp"

namespace slammot::icp_localizer {
namespace {

using testing::DriveSetup;
using testing::SimulatedDrive;

constexpr std::uint32_t kScans = 150;

IcpLocalizerConfig small_map() {
  IcpLocalizerConfig config;
  config.side_m = 100.0;
  return config;
}

SimulatedDrive drive_down_a_street() {
  return SimulatedDrive({.world = testing::street(120.0),
                         .world_from_base_at = testing::arc({2.0, -1.0, 0.02}, 6.0, 0.01)});
}

std::vector<flow::Submap> finished_submaps(IcpLocalizer& localizer) {
  std::vector<flow::Submap> submaps;
  while (auto submap = localizer.take_finished_submap()) submaps.push_back(std::move(*submap));
  return submaps;
}

TEST(IcpLocalizer, FollowsADriveWithOdometry) {
  IcpLocalizer localizer(small_map());
  SimulatedDrive drive = drive_down_a_street();
  const testing::DriveErrors errors = testing::drive_through(localizer, drive, 0, kScans);
  EXPECT_LT(errors.worst_m, 0.3);
  EXPECT_LT(errors.worst_rad, 0.01);
}

TEST(IcpLocalizer, FollowsADriveWithoutOdometryAtConstantVelocity) {
  SimulatedDrive drive({.world = testing::street(120.0),
                        .world_from_base_at = testing::arc({2.0, -1.0, 0.02}, 2.0, 0.02)});
  IcpLocalizer localizer(small_map());
  EXPECT_LT(testing::drive_through(localizer, drive, 0, kScans, false).worst_m, 0.3);
}

TEST(IcpLocalizer, ReducesTheEffectOfAnOdometryBias) {
  DriveSetup setup{.world = testing::street(120.0),
                   .world_from_base_at = testing::arc({2.0, -1.0, 0.02}, 6.0, 0.01)};
  setup.wheels.heading_rate_bias_radps = 0.02;  // 0.3 rad in 15 s; not estimated, so part of it
                                                // distorts the map
  SimulatedDrive drive(setup);
  IcpLocalizer localizer(small_map());
  EXPECT_LT(testing::drive_through(localizer, drive, 0, kScans).worst_rad, 0.1);
}

TEST(IcpLocalizer, DropsARepeatedAndAnOlderScan) {
  IcpLocalizer localizer(small_map());
  SimulatedDrive drive = drive_down_a_street();
  testing::drive_through(localizer, drive, 0, 5);
  EXPECT_FALSE(localizer.localize(drive.scan(4)));
  EXPECT_FALSE(localizer.localize(drive.scan(2)));
  EXPECT_EQ(localizer.named_counters().at("dropped_scans"), 2U);
  EXPECT_TRUE(testing::drive_one(localizer, drive, 5));
}

TEST(IcpLocalizer, ContinuesByOdometryWithoutEchoes) {
  IcpLocalizer localizer(small_map());
  SimulatedDrive drive = drive_down_a_street();
  testing::drive_through(localizer, drive, 0, 20);
  sensing::LaserScan blind = drive.scan(20);
  blind.range_m.assign(blind.range_m.size(), static_cast<float>(blind.scanner.max_range_m));
  localizer.add_odometry(drive.odometry(20));
  const auto localized = localizer.localize(blind);
  ASSERT_TRUE(localized);
  EXPECT_EQ(localizer.named_counters().at("unmatched_scans"), 1U);
  EXPECT_LT(testing::distance_m(localized->odom_from_base.pose, drive.odom_from_base(20)), 0.3);
}

TEST(IcpLocalizer, PredictsTheRangesOfMappedSurfaces) {
  IcpLocalizer localizer(small_map());
  SimulatedDrive drive = drive_down_a_street();
  testing::drive_through(localizer, drive, 0, 30);
  const auto localized = testing::drive_one(localizer, drive, 30);
  const auto occupied = std::ranges::count(localized->beams, flow::EndCell::kOccupied,
                                           &flow::LocalizedBeam::end_cell);
  const auto free =
      std::ranges::count(localized->beams, flow::EndCell::kFree, &flow::LocalizedBeam::end_cell);
  EXPECT_GT(occupied, 90) << "of 181 beams";
  EXPECT_LT(free, 5);
}

TEST(IcpLocalizer, KeepsWhatIsLabelledAsMovingOutOfTheMap) {
  IcpLocalizer localizer(small_map());
  SimulatedDrive drive = drive_down_a_street();
  for (std::uint32_t scan = 0; scan < 5; ++scan) {
    localizer.add_odometry(drive.odometry(scan));
    const auto localized = localizer.localize(drive.scan(scan));
    flow::ScanLabels labels = testing::all_stationary(*localized);
    for (flow::PointLabel& label : labels.labels) label = flow::PointLabel::kMoving;
    localizer.integrate(labels);
  }
  localizer.finish();
  EXPECT_THAT(finished_submaps(localizer).at(0).surfels, ::testing::IsEmpty());
}

TEST(IcpLocalizer, MapsAScanWithoutLabelsWhenTooManyArePending) {
  IcpLocalizer localizer(small_map());
  SimulatedDrive drive = drive_down_a_street();
  for (std::uint32_t scan = 0; scan < 10; ++scan) {
    localizer.add_odometry(drive.odometry(scan));
    ASSERT_TRUE(localizer.localize(drive.scan(scan)));
  }
  EXPECT_EQ(localizer.named_counters().at("unmatched_scans"), 3U)
      << "the map is empty until the fifth scan ends the wait of the first one";
}

TEST(IcpLocalizer, FinishesAChainOfSubmaps) {
  IcpLocalizerConfig config = small_map();
  config.new_map_after_m = 20.0;
  IcpLocalizer localizer(config);
  SimulatedDrive drive = drive_down_a_street();
  testing::drive_through(localizer, drive, 0, kScans);
  localizer.finish();
  const std::vector<flow::Submap> submaps = finished_submaps(localizer);
  ASSERT_GT(submaps.size(), 3U);
  for (std::size_t i = 0; i < submaps.size(); ++i) {
    EXPECT_EQ(submaps[i].submap_id.value, i);
    if (i == 0) continue;
    const geometry::Pose2 chained =
        submaps[i - 1].odom_from_submap * submaps[i].previous_from_submap.pose;
    EXPECT_LT(testing::distance_m(chained, submaps[i].odom_from_submap), 1e-9);
    EXPECT_GT(submaps[i].previous_from_submap.covariance.diagonal().minCoeff(), 0.0);
    EXPECT_GT(submaps[i].first_stamp_ns, submaps[i - 1].first_stamp_ns);
  }
  EXPECT_EQ(finished_submaps(localizer).size(), 0U);
}

TEST(IcpLocalizer, ContinuesAfterFinish) {
  IcpLocalizer localizer(small_map());
  SimulatedDrive drive = drive_down_a_street();
  testing::drive_through(localizer, drive, 0, 40);
  localizer.finish();
  localizer.finish();
  EXPECT_EQ(finished_submaps(localizer).size(), 1U) << "nothing new the second time";
  EXPECT_LT(testing::drive_through(localizer, drive, 40, 80).worst_m, 0.3);
  localizer.finish();
  EXPECT_EQ(finished_submaps(localizer).at(0).submap_id, flow::SubmapId{1});
}

TEST(IcpLocalizer, AppliesCorrectionsOfLoopClosing) {
  IcpLocalizer localizer(small_map());
  SimulatedDrive drive = drive_down_a_street();
  testing::drive_through(localizer, drive, 0, 5);
  flow::GraphCorrection correction;
  correction.map_from_odom = {1.0, 2.0, 0.1};
  localizer.correct(correction);
  EXPECT_EQ(testing::drive_one(localizer, drive, 5)->map_from_odom, correction.map_from_odom);
}

}  // namespace
}  // namespace slammot::icp_localizer
