#include <gtest/gtest.h>

#include "common/dds/serialized_size.hpp"
#include "common/dds/topic_table.hpp"
#include "common/wire/graph.hpp"
#include "common/wire/localized_scan.hpp"
#include "common/wire/scan_labels.hpp"
#include "common/wire/segmented_scan.hpp"
#include "common/wire/sensor.hpp"
#include "common/wire/service.hpp"
#include "common/wire/submap.hpp"
#include "common/wire/tracked_objects.hpp"
#include "common/wire/truth.hpp"
#include "tests/support/values.hpp"

namespace slammot::wire {
namespace {

using dds::serialized_bytes;
namespace topics = dds::topics;

// Larger samples overflow the receiver's socket buffer and take a second instead of a fraction of a
// millisecond.
constexpr std::size_t kMostBytes = 128 * 1024;

struct SizeOfTheLargest : ::testing::Test {
  testing::Random random{1};
};

TEST_F(SizeOfTheLargest, LaserScanFitsTheBus) {
  EXPECT_LE(
      serialized_bytes(topics::kLaserScan,
                       LaserScanEncoder().encode("car", testing::laser_scan(random, kMostBeams))),
      kMostBytes);
}

TEST_F(SizeOfTheLargest, LocalizedScanFitsTheBus) {
  LocalizedScanEncoder encoder;
  EXPECT_LE(serialized_bytes(topics::kLocalizedScan,
                             encoder.encode("car", testing::localized_scan(random, kMostBeams))),
            kMostBytes);
}

TEST_F(SizeOfTheLargest, SegmentedScanFitsTheBus) {
  flow::SegmentedScan scan = testing::segmented_scan(random, kMostBeams);
  scan.segments.resize(kMostSegments);
  for (std::uint16_t beam = 0; beam < kMostBeams; ++beam) {
    scan.segments[beam % kMostSegments].beams.resize(kMostBeams / kMostSegments);
  }
  SegmentedScanEncoder encoder;
  EXPECT_LE(serialized_bytes(topics::kSegmentedScan, encoder.encode("car", scan)), kMostBytes);
}

TEST_F(SizeOfTheLargest, TrackedObjectsFitTheBus) {
  TrackedObjectsEncoder encoder;
  for (const std::uint32_t objects : {1U, 48U, 192U, 500U}) {
    const auto tracks =
        testing::tracked_objects(random, objects, kMostContourPoints, kMostPredictedPositions);
    EXPECT_LE(serialized_bytes(topics::kTrackedObjects, encoder.encode("car", tracks)), kMostBytes);
  }
}

TEST_F(SizeOfTheLargest, TruthFitsTheBus) {
  TruthEncoder encoder;
  simulation::SimulatedScan scan;
  scan.hits.assign(kMostBeams, 5);
  scan.unseen.resize(kMostTrueObjects);
  EXPECT_LE(serialized_bytes(topics::kTrueHits, encoder.encode_hits("car", scan)), kMostBytes);
  EXPECT_LE(serialized_bytes(topics::kTrueObjects, encoder.encode_objects("car", scan)),
            kMostBytes);
}

TEST_F(SizeOfTheLargest, ScanLabelsFitTheBus) {
  flow::ScanLabels labels;
  labels.labels.resize(kMostBeams);
  labels.restored.assign(kMostRestoredScans,
                         {1, std::vector<std::uint16_t>(kMostRestoredPoints / kMostRestoredScans)});
  ScanLabelsEncoder encoder;
  EXPECT_LE(serialized_bytes(topics::kScanLabels, encoder.encode("car", labels)), kMostBytes);
}

TEST_F(SizeOfTheLargest, SubmapTilesFitTheBus) {
  // So many surfels that every tile is full of them.
  const flow::Submap submap = testing::submap(random, 1, 2 * kTileSide, kTileSide, 3 * 4608);
  SubmapEncoder().encode("car", submap, [](const slammot_SubmapTile& tile) {
    EXPECT_LE(serialized_bytes(topics::kSubmapTile, tile), kMostBytes);
  });
}

TEST_F(SizeOfTheLargest, GraphCorrectionFitsTheBus) {
  flow::GraphCorrection correction;
  for (std::uint32_t id = 0; id < kMostSubmapsOfPart; ++id)
    correction.submaps.push_back({{id}, {}});
  GraphCorrectionEncoder().encode("car", correction, [](const slammot_GraphCorrection& part) {
    EXPECT_LE(serialized_bytes(topics::kGraphCorrection, part), kMostBytes);
  });
}

TEST_F(SizeOfTheLargest, StatusFitsTheBus) {
  ServiceStatus status;
  status.missing_inputs.resize(32);
  status.counters.resize(128);
  status.latencies.resize(32);
  StatusEncoder encoder;
  EXPECT_LE(serialized_bytes(topics::kStatus, encoder.encode(status)), kMostBytes);
}

}  // namespace
}  // namespace slammot::wire
