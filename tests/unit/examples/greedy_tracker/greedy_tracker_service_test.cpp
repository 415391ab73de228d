#include "examples/greedy_tracker/greedy_tracker_service.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/overlay.hpp"
#include "common/wire/segmented_scan.hpp"
#include "tests/support/service_on_the_bus.hpp"

namespace slammot::greedy_tracker {
namespace {

using slammot::testing::kForever;
using ::testing::ElementsAre;

/// A pedestrian of three beams that moves along x.
flow::SegmentedScan scan_of(std::uint32_t sequence) {
  flow::Segment segment;
  segment.label = flow::PointLabel::kMoving;
  segment.beams = {0, 1, 2};
  segment.centroid_in_odom_m = segment.box_centre_in_odom_m = {0.2 * sequence, 5.0};
  segment.centroid_covariance_m2 = 1e-4 * Eigen::Matrix2d::Identity();
  flow::SegmentedScan scan;
  scan.stamp_ns = 100'000'000'000 + std::int64_t{sequence} * 100'000'000;
  scan.sequence = sequence;
  scan.scanner_id = "front";
  scan.max_range_m = 50.0;
  scan.beam_step_rad = 0.01;
  scan.points_in_base_m.assign(3, Eigen::Vector2f(0.0F, 5.0F));
  scan.range_m.assign(3, 5.0F);
  scan.labels.assign(3, flow::PointLabel::kMoving);
  scan.segments = {segment};
  return scan;
}

struct GreedyTrackerOnTheBus : slammot::testing::ServiceOnTheBus {
  dds::Writer<slammot_SegmentedScan> scans{neighbour_, dds::topics::kSegmentedScan};
  dds::Reader<slammot_TrackedObjects> objects{neighbour_, dds::topics::kTrackedObjects};
  dds::Reader<slammot_ScanLabels> labels{neighbour_, dds::topics::kScanLabels};
  flow::OdomId odom_id{1};
  std::vector<std::uint32_t> labelled;
  std::vector<std::size_t> confirmed;  ///< Number of tracks, by message.

  void begin() {
    start<GreedyTrackerService>("tracking");
    ASSERT_TRUE(scans.wait_for_readers(1, kForever));
    ASSERT_TRUE(objects.wait_for_writers(1, kForever));
    ASSERT_TRUE(labels.wait_for_writers(1, kForever));
  }
  /// Sends a scan and waits for the answer.
  void track(std::uint32_t sequence) {
    flow::SegmentedScan scan = scan_of(sequence);
    scan.odom_id = odom_id;
    const std::size_t so_far = labelled.size();
    scans.write(wire::SegmentedScanEncoder().encode("car", scan));
    ASSERT_TRUE(comes_to([&] {
      objects.take_each([this](const slammot_TrackedObjects& sample) {
        const auto decoded = wire::decode(sample);
        confirmed.push_back(static_cast<std::size_t>(
            std::ranges::count(decoded->objects, true, &flow::TrackedObject::confirmed)));
      });
      labels.take_each(
          [this](const slammot_ScanLabels& sample) { labelled.push_back(sample.sequence_number); });
      return labelled.size() > so_far && confirmed.size() > so_far;
    }));
  }
};

TEST_F(GreedyTrackerOnTheBus, LabelsEveryScanAndConfirmsAPedestrian) {
  begin();
  std::vector<std::uint32_t> sent;
  for (std::uint32_t sequence = 0; sequence < 20; ++sequence) {
    track(sequence);
    sent.push_back(sequence);
  }
  EXPECT_EQ(labelled, sent);
  EXPECT_EQ(confirmed.front(), 0U);
  EXPECT_EQ(confirmed.back(), 1U);
}

TEST_F(GreedyTrackerOnTheBus, RepeatsTheLatestAnswerToARepeatedScan) {
  begin();
  for (const std::uint32_t sequence : {0U, 1U, 1U, 0U}) track(sequence);
  EXPECT_THAT(labelled, ElementsAre(0, 1, 1, 1));
}

TEST_F(GreedyTrackerOnTheBus, DiscardsItsTracksWithANewDrive) {
  begin();
  for (std::uint32_t sequence = 0; sequence < 20; ++sequence) track(sequence);
  odom_id = {2};
  track(0);
  EXPECT_EQ(labelled.back(), 0U);
  EXPECT_EQ(confirmed.back(), 0U);
}

TEST(GreedyTrackerSettings, AreASubsetOfThoseOfTheStageThatItReplaces) {
  GreedyTrackerService::Settings settings;
  const auto stages = GreedyTrackerService::stages(settings);
  const auto fault = config::overlay_text(
      "tracking { fastest_mps: 5 } localization { match_range_m: 30 }", "profile", stages);
  ASSERT_FALSE(fault) << fault->text();
  EXPECT_EQ(settings.config.fastest_mps, 5.0);
}

}  // namespace
}  // namespace slammot::greedy_tracker
