#include "services/tracking/tracking_service.hpp"

#include <filesystem>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/app/system_clock.hpp"
#include "common/wire/segmented_scan.hpp"
#include "tests/support/service_on_the_bus.hpp"

namespace slammot::tracking {
namespace {

using slammot::testing::kForever;

constexpr std::int64_t kScanNs = 100'000'000'000;

flow::SegmentedScan empty_scan(std::uint32_t sequence) {
  flow::SegmentedScan scan;
  scan.stamp_ns = kScanNs + std::int64_t{sequence} * 100'000'000;
  scan.sequence = sequence;
  scan.scanner_id = "front";
  scan.max_range_m = 50.0;
  scan.beam_step_rad = 0.01;
  scan.points_in_base_m.assign(10, Eigen::Vector2f::Zero());
  scan.range_m.assign(10, 0.0F);
  scan.labels.assign(10, flow::PointLabel::kNoEcho);
  return scan;
}

flow::TrackedObjects one_car(std::int64_t stamp_ns) {
  flow::TrackedObject car;
  car.track_id = {17};
  car.confirmed = true;
  car.existence = 0.99;
  car.position_in_odom_m = {20.0, 5.0};
  car.velocity_in_odom_mps = {8.0, 0.0};
  car.covariance = Eigen::Matrix4d::Identity() * 0.1;
  car.length_m = 4.5;
  car.width_m = 1.8;
  car.first_seen_ns = stamp_ns - 3'000'000'000;
  car.last_seen_ns = stamp_ns;
  flow::TrackedObjects objects;
  objects.stamp_ns = stamp_ns;
  objects.map_id = {7};
  objects.odom_id = {1};
  objects.objects = {car};
  return objects;
}

struct TrackingOnTheBus : slammot::testing::ServiceOnTheBus {
  /// Of detection; another one has nothing of the scans before it.
  std::optional<dds::Writer<slammot_SegmentedScan>> scans;
  dds::Writer<slammot_TrackedObjects> stored{neighbour_, dds::topics::kStoredTrackedObjects};
  dds::Reader<slammot_TrackedObjects> objects{neighbour_, dds::topics::kTrackedObjects};
  dds::Reader<slammot_ScanLabels> labels{neighbour_, dds::topics::kScanLabels};
  flow::MapId map_id{7};
  flow::OdomId odom_id{1};
  std::vector<flow::TrackedObjects> published;
  std::vector<std::uint32_t> labelled;
  bool is_blank = false;  ///< Scans have no beams: tracks are predicted, and stay.

  void SetUp() override { restart_detection(); }
  void restart_detection() { scans.emplace(neighbour_, dds::topics::kSegmentedScan); }
  void begin() {
    start<TrackingService>("tracking");
    ASSERT_TRUE(scans->wait_for_readers(1, kForever));
    ASSERT_TRUE(objects.wait_for_writers(1, kForever));
    ASSERT_TRUE(labels.wait_for_writers(1, kForever));
  }
  void send(std::uint32_t sequence) {
    flow::SegmentedScan scan = empty_scan(sequence);
    scan.map_id = map_id;
    scan.odom_id = odom_id;
    if (is_blank) scan.points_in_base_m.clear(), scan.range_m.clear(), scan.labels.clear();
    scans->write(wire::SegmentedScanEncoder().encode("car", scan));
  }
  std::filesystem::path journal() const { return folder_ / "tracking-car.journal"; }
  /// Tracks a car with id 17, without a journal, and leaves the process's journal as it was once
  /// saved: as a kill does.
  void track_a_car_until_killed() {
    stored.write(wire::TrackedObjectsEncoder().encode("car", one_car(kScanNs - 100'000'000)));
    is_blank = true;
    begin();
    for (std::uint32_t sequence = 0; sequence < 8; ++sequence) {
      send(sequence);
      ASSERT_TRUE(comes_to([&] { return has_labelled(sequence + 1); }));
    }
    ASSERT_TRUE(comes_to([this] { return exists(journal()); }));
    const std::filesystem::path kept = folder_ / "kept";
    copy_file(journal(), kept);
    stop();
    rename(kept, journal());
    stored.write(wire::TrackedObjectsEncoder().encode("car", {}));
    published.clear();
    labelled.clear();
  }
  bool has_labelled(std::size_t count) {
    objects.take_each([this](const auto& sample) { published.push_back(*wire::decode(sample)); });
    labels.take_each(
        [this](const slammot_ScanLabels& sample) { labelled.push_back(sample.sequence_number); });
    return labelled.size() >= count;
  }
};

TEST_F(TrackingOnTheBus, TellsHowLongAgoTheScanWasPublished) {
  begin();
  const std::int64_t published_ns = app::system_clock_ns() - 5'000'000;
  scans->write(wire::SegmentedScanEncoder().encode("car", empty_scan(0), published_ns));
  std::optional<std::int64_t> carried_ns;
  ASSERT_TRUE(comes_to([&] {
    objects.take_each([&](const auto& sample) { carried_ns = sample.scan_published_ns; });
    return carried_ns && context_->status().latency("scan_to_tracks").count() > 0;
  }));
  EXPECT_EQ(carried_ns, published_ns);
  EXPECT_GE(context_->status().latency("scan_to_tracks").highest_ms(), 5.0);
}

TEST_F(TrackingOnTheBus, LabelsEveryScan) {
  begin();
  for (const std::uint32_t sequence : {0U, 1U, 2U}) send(sequence);
  ASSERT_TRUE(comes_to([this] { return has_labelled(3); }));
  EXPECT_THAT(labelled, ::testing::ElementsAre(0, 1, 2));
}

TEST_F(TrackingOnTheBus, GivesTheSameAnswerToAScanThatComesAgain) {
  begin();
  for (const std::uint32_t sequence : {0U, 1U, 1U, 0U}) send(sequence);
  ASSERT_TRUE(comes_to([this] { return has_labelled(4); }));
  EXPECT_THAT(labelled, ::testing::ElementsAre(0, 1, 1, 1))
      << "the newest answer tells how far tracking is";
}

TEST_F(TrackingOnTheBus, TakesUpTheTracksOfTheProcessBefore) {
  stored.write(wire::TrackedObjectsEncoder().encode("car", one_car(kScanNs - 100'000'000)));
  begin();
  send(0);
  ASSERT_TRUE(comes_to([this] { return has_labelled(1); }));
  ASSERT_EQ(published.front().objects.size(), 1U);
  EXPECT_EQ(published.front().objects.front().track_id, flow::TrackId{17});
  EXPECT_NEAR(published.front().objects.front().position_in_odom_m.x(), 20.8, 0.3)
      << "predicted over the gap";
}

TEST_F(TrackingOnTheBus, GoesOnFromItsJournalAfterAKill) {
  track_a_car_until_killed();
  restart_detection();
  begin();
  send(8);
  ASSERT_TRUE(comes_to([this] { return has_labelled(1); }));
  ASSERT_EQ(published.front().objects.size(), 1U);
  EXPECT_EQ(published.front().objects.front().track_id, flow::TrackId{17});
  EXPECT_EQ(context_->status().counter("taken_up"), 1U);
}

TEST_F(TrackingOnTheBus, WorksThroughWhatDetectionKeptSinceTheJournal) {
  track_a_car_until_killed();
  send(8);  // while tracking is away
  begin();
  ASSERT_TRUE(comes_to([this] { return has_labelled(1) && labelled.back() == 8; }));
  EXPECT_THAT(labelled, ::testing::IsSupersetOf({6U, 7U, 8U}));
  for (const flow::TrackedObjects& objects : published) {
    ASSERT_EQ(objects.objects.size(), 1U);
    EXPECT_EQ(objects.objects.front().track_id, flow::TrackId{17});
  }
}

TEST_F(TrackingOnTheBus, GoesOnWithTheVeryLastScanAfterAStop) {
  track_a_car_until_killed();
  restart_detection();
  begin();
  send(9);
  ASSERT_TRUE(comes_to([this] { return has_labelled(1); }));
  stop();
  restart_detection();
  begin();
  send(9);
  ASSERT_TRUE(comes_to([this] { return has_labelled(2); }));
  EXPECT_EQ(context_->status().counter("repeated_scans"), 1U) << "the answer was kept, too";
  ASSERT_EQ(published.front().objects.size(), 1U);
  ASSERT_EQ(published.back().objects.size(), 1U);
  EXPECT_EQ(published.front().objects.front().position_in_odom_m,
            published.back().objects.front().position_in_odom_m);
}

TEST_F(TrackingOnTheBus, LeavesTheJournalOfAnotherDriveAlone) {
  track_a_car_until_killed();
  restart_detection();
  odom_id = {2};
  begin();
  send(8);
  ASSERT_TRUE(comes_to([this] { return has_labelled(1); }));
  EXPECT_THAT(published.front().objects, ::testing::IsEmpty());
}

TEST_F(TrackingOnTheBus, BeginsAnewWhereTheJournalIsDamaged) {
  track_a_car_until_killed();
  restart_detection();
  resize_file(journal(), file_size(journal()) / 2);
  begin();
  send(8);
  ASSERT_TRUE(comes_to([this] { return has_labelled(1); }));
  EXPECT_THAT(published.front().objects, ::testing::IsEmpty());
}

TEST_F(TrackingOnTheBus, SaysThatItCannotWriteItsJournal) {
  create_directories(journal());
  begin();
  std::uint32_t sequence = 0;
  EXPECT_TRUE(comes_to([&] {
    send(sequence++);
    return context_->status().explanation(std::chrono::steady_clock::now()).find("no journal") !=
           std::string::npos;
  }));
}

TEST_F(TrackingOnTheBus, LeavesTracksOfAnotherDriveAlone) {
  stored.write(wire::TrackedObjectsEncoder().encode("car", one_car(kScanNs - 500'000'000'000)));
  begin();
  send(0);
  ASSERT_TRUE(comes_to([this] { return has_labelled(1); }));
  EXPECT_THAT(published.front().objects, ::testing::IsEmpty());
}

TEST_F(TrackingOnTheBus, LeavesTracksOfAnotherMapAloneThoughTheirTimeIsTheSame) {
  flow::TrackedObjects of_earlier_map = one_car(kScanNs - 100'000'000);
  of_earlier_map.map_id = {6};
  stored.write(wire::TrackedObjectsEncoder().encode("car", of_earlier_map));
  begin();
  send(0);
  ASSERT_TRUE(comes_to([this] { return has_labelled(1); }));
  EXPECT_THAT(published.front().objects, ::testing::IsEmpty());
}

TEST_F(TrackingOnTheBus, LeavesTracksOfAnotherDriveInTheSameMapAloneThoughTheirTimeIsTheSame) {
  flow::TrackedObjects of_earlier_drive = one_car(kScanNs - 100'000'000);
  of_earlier_drive.odom_id = {0};
  stored.write(wire::TrackedObjectsEncoder().encode("car", of_earlier_drive));
  begin();
  send(0);
  ASSERT_TRUE(comes_to([this] { return has_labelled(1); }));
  EXPECT_THAT(published.front().objects, ::testing::IsEmpty());
}

TEST_F(TrackingOnTheBus, BeginsAnewWhereAnotherDriveGoesOnInTheSameMapThoughItsStampsGoBack) {
  begin();
  for (const std::uint32_t sequence : {5U, 6U}) send(sequence);
  odom_id = {2};
  for (const std::uint32_t sequence : {0U, 1U}) send(sequence);
  ASSERT_TRUE(comes_to([this] { return has_labelled(4); }));
  EXPECT_THAT(labelled, ::testing::ElementsAre(5, 6, 0, 1));
}

TEST_F(TrackingOnTheBus, BeginsAnewWithANewMapThoughItsTimeIsTheSame) {
  begin();
  for (const std::uint32_t sequence : {0U, 1U}) send(sequence);
  map_id = {8};
  for (const std::uint32_t sequence : {0U, 1U}) send(sequence);
  ASSERT_TRUE(comes_to([this] { return has_labelled(4); }));
  EXPECT_THAT(labelled, ::testing::ElementsAre(0, 1, 0, 1));
}

}  // namespace
}  // namespace slammot::tracking
