#include "common/files/run_record.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/example_submap.hpp"
#include "tests/support/matchers.hpp"

namespace slammot::files {
namespace {

using geometry::Pose2;
using testing::PoseNear;

flow::LocalizedScan localized(std::int64_t stamp_ns, double odom_x_m, std::uint32_t submap_id = 0) {
  flow::LocalizedScan scan;
  scan.stamp_ns = stamp_ns;
  scan.odom_from_base.pose = {odom_x_m, 0.0, 0.0};
  scan.submap_id = {submap_id};
  scan.submap_from_base = {odom_x_m - 10.0 * submap_id, 0.0, 0.0};
  return scan;
}

flow::TrackedObjects tracked(std::int64_t stamp_ns,
                             std::vector<std::pair<std::uint32_t, bool>> ids) {
  flow::TrackedObjects message;
  message.stamp_ns = stamp_ns;
  for (const auto& [id, confirmed] : ids) {
    flow::TrackedObject object;
    object.track_id = {id};
    object.confirmed = confirmed;
    object.position_in_odom_m = {1.0, 0.0};
    object.velocity_in_odom_mps = {3.0, 0.0};
    message.objects.push_back(object);
  }
  return message;
}

TEST(RunRecord, HasARowForEveryScanOfTheLogInItsOrder) {
  RunRecord record;
  for (const std::int64_t stamp_ns : {100, 200, 150, 200, 300})
    record.add_scan(stamp_ns);  // one late, one twice
  record.add(localized(100, 1.0));
  record.add(localized(200, 3.0));
  const auto trajectory = record.online_trajectory();
  ASSERT_EQ(trajectory.size(), 5u);
  EXPECT_EQ(trajectory[2].stamp_ns, 150);
  EXPECT_THAT(trajectory[0].map_from_base, PoseNear(Pose2{1.0, 0.0, 0.0}, 1e-12));
  // between its neighbours in time
  EXPECT_THAT(trajectory[2].map_from_base, PoseNear(Pose2{2.0, 0.0, 0.0}, 1e-12));
  EXPECT_THAT(trajectory[3].map_from_base, PoseNear(Pose2{3.0, 0.0, 0.0}, 1e-12));
  // the nearest there is
  EXPECT_THAT(trajectory[4].map_from_base, PoseNear(Pose2{3.0, 0.0, 0.0}, 1e-12));
}

TEST(RunRecord, HasRowsEvenWhenNothingWasLocalized) {
  RunRecord record;
  record.add_scan(100);
  EXPECT_EQ(record.online_trajectory().size(), 1u);
  EXPECT_EQ(record.corrected_trajectory().size(), 1u);
}

TEST(RunRecord, KeepsWhatWasPublishedLiveAndMovesTheRestWithItsSubmap) {
  RunRecord record;
  record.add_scan(100);
  record.add_scan(200);
  record.add(localized(100, 1.0, 0));
  record.add(localized(200, 12.0, 1));
  record.add(
      flow::GraphCorrection{1, {5.0, 0.0, 0.0}, {{{0}, {0.0, 1.0, 0.0}}, {{1}, {0.0, 7.0, 0.0}}}});
  EXPECT_THAT(record.online_trajectory()[1].map_from_base, PoseNear(Pose2{12.0, 0.0, 0.0}, 1e-12));
  EXPECT_THAT(record.corrected_trajectory()[0].map_from_base,
              PoseNear(Pose2{1.0, 1.0, 0.0}, 1e-12));
  EXPECT_THAT(record.corrected_trajectory()[1].map_from_base,
              PoseNear(Pose2{2.0, 7.0, 0.0}, 1e-12));
}

TEST(RunRecord, PlacesWhatLoopClosingNeverHeardOfByOdometry) {
  RunRecord record;
  record.add_scan(100);
  record.add(localized(100, 12.0, 1));
  record.add(flow::GraphCorrection{1, {5.0, 0.0, 0.0}, {{{0}, {0.0, 1.0, 0.0}}}});
  EXPECT_THAT(record.corrected_trajectory()[0].map_from_base,
              PoseNear(Pose2{17.0, 0.0, 0.0}, 1e-12));
  flow::Submap submap = testing::example_submap(1);
  EXPECT_THAT(record.map_from_submap(submap),
              PoseNear(Pose2{5.0, 0.0, 0.0} * submap.odom_from_submap, 1e-12));
}

TEST(RunRecord, PlacesScansOfALostVehicleWithTheSubmapThatBeganThen) {
  RunRecord record;
  for (const std::int64_t stamp_ns : {100, 200, 300}) record.add_scan(stamp_ns);
  record.add(localized(100, 1.0, 0));
  record.add(localized(200, 2.0, 0));  // lost
  record.add(localized(300, 12.0, 1));
  flow::Submap begun_lost = testing::example_submap(1);
  begun_lost.submap_id = {1};
  begun_lost.first_stamp_ns = 200;
  begun_lost.odom_from_submap = {10.0, 0.0, 0.0};
  record.add(begun_lost);
  record.add(
      flow::GraphCorrection{1, {5.0, 0.0, 0.0}, {{{0}, {0.0, 1.0, 0.0}}, {{1}, {0.0, 7.0, 0.0}}}});
  const auto trajectory = record.corrected_trajectory();
  EXPECT_THAT(trajectory[0].map_from_base, PoseNear(Pose2{1.0, 1.0, 0.0}, 1e-12));
  EXPECT_THAT(trajectory[1].map_from_base, PoseNear(Pose2{-8.0, 7.0, 0.0}, 1e-12));
  EXPECT_THAT(trajectory[2].map_from_base, PoseNear(Pose2{2.0, 7.0, 0.0}, 1e-12));
}

TEST(RunRecord, IgnoresACorrectionOlderThanTheLast) {
  RunRecord record;
  record.add(flow::GraphCorrection{2, {}, {{{1}, {2.0, 0.0, 0.0}}}});
  record.add(flow::GraphCorrection{1, {}, {{{1}, {9.0, 0.0, 0.0}}}});
  EXPECT_THAT(record.map_from_submap(testing::example_submap(1)),
              PoseNear(Pose2{2.0, 0.0, 0.0}, 1e-12));
}

TEST(RunRecord, TakesWhatComesAgainForTheSameThing) {
  RunRecord record;
  record.add(localized(100, 1.0));
  record.add(localized(100, 1.0));
  record.add(testing::example_submap(3));
  record.add(testing::example_submap(3));
  record.add(tracked(100, {{7, true}}));
  record.add(tracked(100, {{7, true}}));
  record.add(flow::Constraint{{0}, {1}, flow::ConstraintKind::kLoop, {}});
  record.add(flow::Constraint{{0}, {1}, flow::ConstraintKind::kLoop, {}});
  record.add(flow::Constraint{{0}, {1}, flow::ConstraintKind::kOdometric, {}});
  EXPECT_EQ(record.localized_scans(), 1u);
  EXPECT_EQ(record.submaps().size(), 1u);
  EXPECT_EQ(record.track_rows().size(), 1u);
  EXPECT_EQ(record.constraints().size(), 2u);
}

TEST(RunRecord, ReportsConfirmedTracksInMapAsPublished) {
  RunRecord record;
  flow::TrackedObjects message = tracked(100, {{7, true}, {8, false}});
  message.map_from_odom = {10.0, 0.0, std::acos(0.0)};  // a quarter turn
  record.add(message);
  record.add(tracked(200, {{9, true}, {7, true}}));
  const auto rows = record.track_rows();
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(record.confirmed_tracks(), 2u);
  EXPECT_NEAR(rows[0]->map_from_object.x_m, 10.0, 1e-12);
  EXPECT_NEAR(rows[0]->map_from_object.y_m, 1.0, 1e-12);
  EXPECT_NEAR(rows[0]->velocity_in_map_mps.y(), 3.0, 1e-12);
}

TEST(RunRecord, TurnsCovariancesOfTracksIntoMap) {
  RunRecord record;
  flow::TrackedObjects message = tracked(100, {{7, true}});
  message.map_from_odom = {0.0, 0.0, std::acos(0.0)};
  message.objects[0].covariance.diagonal() << 4.0, 1.0, 0.5, 0.25;
  record.add(message);
  const Eigen::Matrix4d covariance = record.track_rows().at(0)->covariance_in_map;
  EXPECT_NEAR(covariance(0, 0), 1.0, 1e-12);
  EXPECT_NEAR(covariance(1, 1), 4.0, 1e-12);
  EXPECT_NEAR(covariance(3, 3), 0.5, 1e-12);
}

TEST(RunRecord, JoinsTheLabelsOfDetectionAndTracking) {
  RunRecord record;
  flow::SegmentedScan segmented;
  segmented.stamp_ns = 100;
  segmented.labels = {flow::PointLabel::kNoEcho, flow::PointLabel::kStationary,
                      flow::PointLabel::kUnknown};
  flow::ScanLabels labels;
  labels.stamp_ns = 100;
  labels.labels = {flow::PointLabel::kNoEcho, flow::PointLabel::kStationary,
                   flow::PointLabel::kMoving};
  record.add(segmented);
  record.add(labels);
  ASSERT_EQ(record.label_rows().size(), 1u);
  EXPECT_EQ(record.label_rows()[0]->by_detection, "-s?");
  EXPECT_EQ(record.label_rows()[0]->by_tracking, "-sm");
}

TEST(RunRecord, KeepsScansOfSeveralScannersApartThatShareAStamp) {
  RunRecord record;
  for (const char* const scanner_id : {"front", "rear", "front"}) {
    flow::LocalizedScan scan;
    scan.stamp_ns = 100;
    scan.scanner_id = scanner_id;
    record.add(scan);
    flow::ScanLabels labels;
    labels.stamp_ns = 100;
    labels.scanner_id = scanner_id;
    labels.labels = {flow::PointLabel::kMoving};
    record.add(labels);
  }
  EXPECT_EQ(record.localized_scans(), 2u);
  ASSERT_EQ(record.label_rows().size(), 2u);
  EXPECT_EQ(record.label_rows()[1]->scanner_id, "rear");
}

TEST(RunRecord, KnowsWhereItIsByTheLastCorrection) {
  RunRecord record;
  EXPECT_TRUE(record.is_connected());
  record.add(flow::GraphCorrection{.sequence = 1, .is_untied = true});
  EXPECT_FALSE(record.is_connected());
  record.add(flow::GraphCorrection{.sequence = 2});
  EXPECT_TRUE(record.is_connected());
}

TEST(RunRecord, ForgetsADriveButNotItsMap) {
  RunRecord record;
  flow::LocalizedScan scan;
  scan.stamp_ns = 5;
  record.add_scan(5);
  record.add(scan);
  record.add(flow::Submap{.submap_id = {3}});
  record.forget_drive();
  EXPECT_EQ(record.scans(), 0U);
  EXPECT_EQ(record.localized_scans(), 0U);
  EXPECT_EQ(record.submaps().size(), 1U);
}

}  // namespace
}  // namespace slammot::files
