#include "services/slammot/collector.hpp"

#include <algorithm>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/wire/localized_scan.hpp"
#include "common/wire/scan_labels.hpp"
#include "common/wire/segmented_scan.hpp"
#include "common/wire/sensor.hpp"
#include "common/wire/service.hpp"
#include "common/wire/submap.hpp"
#include "common/wire/tracked_objects.hpp"
#include "tests/support/dds.hpp"
#include "tests/support/example_submap.hpp"
#include "tests/support/temporary_folder.hpp"

namespace slammot {
namespace {

using namespace std::chrono_literals;
using slammot::testing::kForever;

constexpr std::int64_t kPeriodNs = 100'000'000;

/// Stands in for ingest, localization and tracking of one vehicle.
struct CollectorOnTheBus : ::testing::Test {
  slammot::testing::TemporaryFolder folder;
  slammot::testing::PrivateBus bus;
  dds::Participant services = bus.join();
  dds::Writer<slammot_LaserScan> scans{services, dds::topics::kLaserScan};
  dds::Writer<slammot_LocalizedScan> localized_scans{services, dds::topics::kLocalizedScan};
  dds::Writer<slammot_TrackedObjects> tracked_objects{services, dds::topics::kTrackedObjects};
  dds::Writer<slammot_ServiceStatus> statuses{services, dds::topics::kStatus};
  std::optional<Collector> collector;

  void start() {
    collector.reset();
    while (scans.matched_readers() + localized_scans.matched_readers() +
               tracked_objects.matched_readers() >
           0)
      std::this_thread::yield();
    collector.emplace(CollectorOptions{"car", bus.domain_id, bus.config, folder / "journal"});
    ASSERT_TRUE(scans.wait_for_readers(1, kForever));
    ASSERT_TRUE(localized_scans.wait_for_readers(1, kForever));
    ASSERT_TRUE(tracked_objects.wait_for_readers(1, kForever));
  }

  void say_that_log_is_finished(bool is_finished) {
    wire::StatusEncoder encoder;
    statuses.write(encoder.encode({.name = {"car", "ingest", "main"},
                                   .counters = {{"log_finished", is_finished ? 1U : 0U}}}));
  }

  /// Passes one scan through all services.
  void drive(std::uint32_t sequence, std::uint64_t drive_id, flow::MapId map_id,
             flow::OdomId odom_id = {}) {
    sensing::LaserScan scan;
    scan.stamp_ns = std::int64_t{sequence} * kPeriodNs;
    scan.sequence = sequence;
    scan.scanner = {.scanner_id = "front",
                    .base_from_laser = {},
                    .first_beam_rad = 0.0,
                    .beam_step_rad = 0.1,
                    .max_range_m = 50.0,
                    .sweep_s = 0.0};
    scan.range_m = {5.0F};
    flow::LocalizedScan localized;
    localized.stamp_ns = scan.stamp_ns;
    localized.sequence = sequence;
    localized.scanner_id = "front";
    localized.map_id = map_id;
    localized.odom_id = odom_id;
    flow::TrackedObjects objects;
    objects.stamp_ns = scan.stamp_ns;
    objects.map_id = map_id;
    objects.odom_id = odom_id;
    scans.write(wire::LaserScanEncoder(drive_id).encode("car", scan));
    localized_scans.write(wire::LocalizedScanEncoder().encode("car", localized));
    tracked_objects.write(wire::TrackedObjectsEncoder().encode("car", objects));
  }

  std::uint64_t localized_count() const { return collector->record({}).localized_scans(); }

  ::testing::AssertionResult comes_to(const std::function<bool()>& condition) {
    const auto end = std::chrono::steady_clock::now() + kForever;
    while (!condition()) {
      if (std::chrono::steady_clock::now() > end)
        return ::testing::AssertionFailure() << "did not happen";
      collector->wait(5ms);
    }
    return ::testing::AssertionSuccess();
  }
};

TEST_F(CollectorOnTheBus, IgnoresALogThatFinishedBeforeItsStart) {
  say_that_log_is_finished(true);
  start();
  ASSERT_TRUE(comes_to([this] { return !collector->counters().empty(); }));
  EXPECT_FALSE(collector->has_drive_ended());
}

TEST_F(CollectorOnTheBus, EndsWithTheLastScanOfTheLog) {
  start();
  for (const std::uint32_t sequence : {0U, 1U, 2U}) drive(sequence, 1, {7});
  ASSERT_TRUE(comes_to([this] { return localized_count() == 3; }));
  EXPECT_FALSE(collector->has_drive_ended());
  say_that_log_is_finished(true);
  EXPECT_TRUE(comes_to([this] { return collector->has_drive_ended(); }));
}

TEST_F(CollectorOnTheBus, DiscardsThePreviousDriveWhenANewOneBegins) {
  start();
  for (const std::uint32_t sequence : {0U, 1U, 2U}) drive(sequence, 1, {7});
  ASSERT_TRUE(comes_to([this] { return localized_count() == 3; }));
  drive(0, 2, {8});
  ASSERT_TRUE(comes_to([this] { return localized_count() == 1; }));
  EXPECT_TRUE(comes_to([this] { return collector->scan_stamps_ns().size() == 1; }));
}

TEST_F(CollectorOnTheBus, KeepsTheMapButNotTheScansOfAPreviousDriveInIt) {
  dds::Writer<slammot_SubmapTile> tiles(services, dds::topics::kStoredSubmapTile);
  start();
  flow::Submap submap = slammot::testing::example_submap(0);
  submap.map_id = {7};
  wire::SubmapEncoder().encode("car", submap,
                               [&](const slammot_SubmapTile& tile) { tiles.write(tile); });
  for (const std::uint32_t sequence : {5U, 6U, 7U}) drive(sequence, 1, {7}, {1});
  ASSERT_TRUE(comes_to(
      [this] { return localized_count() == 3 && collector->record({}).submaps().size() == 1; }));
  drive(0, 2, {7}, {2});
  ASSERT_TRUE(comes_to([this] { return localized_count() == 1; }));
  EXPECT_EQ(collector->record({}).submaps().size(), 1U);
  EXPECT_TRUE(comes_to([this] {
    return std::ranges::equal(collector->scan_stamps_ns(), std::vector<std::int64_t>{0});
  })) << "a lone scan of another drive counts once nothing else came for 0.9 s";
}

TEST_F(CollectorOnTheBus, KeepsTheLabelsOfDetectionAndTracking) {
  dds::Writer<slammot_SegmentedScan> segmented_scans(services, dds::topics::kSegmentedScan);
  dds::Writer<slammot_ScanLabels> scan_labels(services, dds::topics::kScanLabels);
  start();
  ASSERT_TRUE(segmented_scans.wait_for_readers(1, kForever) &&
              scan_labels.wait_for_readers(1, kForever));
  drive(1, 1, {7});
  ASSERT_TRUE(comes_to([this] { return localized_count() == 1; }));
  flow::SegmentedScan segmented;
  segmented.stamp_ns = kPeriodNs;
  segmented.scanner_id = "front";
  segmented.map_id = {7};
  segmented.points_in_base_m.resize(2);
  segmented.range_m = {5.0F, 6.0F};
  segmented.labels = {flow::PointLabel::kStationary, flow::PointLabel::kUnknown};
  segmented_scans.write(wire::SegmentedScanEncoder().encode("car", segmented));
  scan_labels.write(wire::ScanLabelsEncoder().encode(
      "car",
      {kPeriodNs, 1, "front", {flow::PointLabel::kStationary, flow::PointLabel::kMoving}, {}}));
  ASSERT_TRUE(comes_to([this] {
    const files::RunRecord record = collector->record({});
    const auto rows = record.label_rows();
    return rows.size() == 1 && !rows[0]->by_detection.empty() && !rows[0]->by_tracking.empty();
  }));
  const files::RunRecord record = collector->record({});
  EXPECT_EQ(record.label_rows()[0]->by_detection, "s?");
  EXPECT_EQ(record.label_rows()[0]->by_tracking, "sm");
}

TEST_F(CollectorOnTheBus, DetectsTheEndOfASimulatedDrive) {
  start();
  drive(0, 1, {7});
  ASSERT_TRUE(comes_to([this] { return localized_count() == 1; }));
  wire::StatusEncoder encoder;
  statuses.write(
      encoder.encode({.name = {"car", "simulator", "main"}, .counters = {{"log_finished", 1U}}}));
  EXPECT_TRUE(comes_to([this] { return collector->has_drive_ended(); }));
}

TEST_F(CollectorOnTheBus, ContinuesAfterACrash) {
  start();
  for (const std::uint32_t sequence : {0U, 1U, 2U}) drive(sequence, 1, {7});
  ASSERT_TRUE(comes_to(
      [this] { return localized_count() == 3 && collector->scan_stamps_ns().size() == 3; }));
  start();
  drive(3, 1, {7});
  ASSERT_TRUE(comes_to([this] { return localized_count() == 4; }));
  EXPECT_THAT(collector->scan_stamps_ns(),
              ::testing::ElementsAre(0, kPeriodNs, 2 * kPeriodNs, 3 * kPeriodNs));
}

TEST_F(CollectorOnTheBus, TakesWhatWasPublishedWhileItWasDown) {
  start();
  for (const std::uint32_t sequence : {0U, 1U}) drive(sequence, 1, {7});
  ASSERT_TRUE(comes_to(
      [this] { return localized_count() == 2 && collector->scan_stamps_ns().size() == 2; }));
  collector.reset();
  for (const std::uint32_t sequence : {2U, 3U}) drive(sequence, 1, {7});
  start();
  ASSERT_TRUE(comes_to([this] { return localized_count() == 4; }));
  EXPECT_THAT(collector->scan_stamps_ns(),
              ::testing::ElementsAre(0, kPeriodNs, 2 * kPeriodNs, 3 * kPeriodNs));
}

TEST_F(CollectorOnTheBus, LeavesAnEndedDriveInTheHistoryOfTheBus) {
  start();
  for (const std::uint32_t sequence : {5U, 6U}) drive(sequence, 1, {7}, {1});
  ASSERT_TRUE(comes_to([this] { return localized_count() == 2; }));
  drive(0, 2, {7}, {2});
  ASSERT_TRUE(comes_to([this] { return localized_count() == 1; }));
  collector.reset();
  drive(1, 2, {7}, {2});
  start();
  ASSERT_TRUE(comes_to([this] { return localized_count() == 2; }));
  EXPECT_EQ(collector->last_localized_ns(), kPeriodNs);
}

TEST_F(CollectorOnTheBus, DoesNotMixADriveFromBeforeItsCrashWithANewOne) {
  start();
  for (const std::uint32_t sequence : {0U, 1U, 2U}) drive(sequence, 1, {7});
  ASSERT_TRUE(comes_to([this] { return localized_count() == 3; }));
  start();
  drive(0, 2, {8});
  ASSERT_TRUE(comes_to([this] { return localized_count() == 1; }));
  EXPECT_TRUE(comes_to([this] {
    return std::ranges::equal(collector->scan_stamps_ns(), std::vector<std::int64_t>{0});
  })) << "a lone scan of another drive counts once nothing else came for 0.9 s";
}

TEST_F(CollectorOnTheBus, DoesNotMixADriveFromBeforeItsCrashWithANewOneInTheSameMap) {
  start();
  for (const std::uint32_t sequence : {0U, 1U, 2U}) drive(sequence, 1, {7}, {1});
  ASSERT_TRUE(comes_to([this] { return localized_count() == 3; }));
  start();
  drive(0, 2, {7}, {2});
  ASSERT_TRUE(comes_to([this] { return localized_count() == 1; }));
}

TEST_F(CollectorOnTheBus, RemovesTheJournalOnceItsResultsAreWritten) {
  start();
  drive(0, 1, {7});
  ASSERT_TRUE(comes_to([this] { return localized_count() == 1; }));
  collector->remove_journal();
  start();
  EXPECT_EQ(localized_count(), 0U);
}

}  // namespace
}  // namespace slammot
