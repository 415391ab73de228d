#include "services/gateway/scan_pairing.hpp"

#include <gtest/gtest.h>

#include "services/gateway/scan_messages.hpp"
#include "services/gateway/track_messages.hpp"

namespace slammot::gateway {
namespace {

flow::LocalizedScan scan_at(std::int64_t stamp_ns) {
  flow::LocalizedScan scan;
  scan.stamp_ns = stamp_ns;
  scan.scanner_id = "front";
  return scan;
}

flow::ScanLabels labels_at(std::int64_t stamp_ns) {
  flow::ScanLabels labels;
  labels.stamp_ns = stamp_ns;
  labels.scanner_id = "front";
  labels.labels = {flow::PointLabel::kMoving};
  return labels;
}

struct Emitted {
  std::int64_t stamp_ns;
  bool has_labels;
};

class ScanPairingTest : public ::testing::Test {
 protected:
  std::vector<Emitted> emitted_;
  ScanPairing pairing_{[this](const flow::LocalizedScan& scan, const auto& labels) {
    emitted_.push_back({scan.stamp_ns, !labels.empty()});
  }};
};

TEST_F(ScanPairingTest, JoinsAScanWithItsLabels) {
  pairing_.take(scan_at(1));
  pairing_.take(scan_at(2));
  EXPECT_TRUE(emitted_.empty());
  pairing_.take(labels_at(2));
  ASSERT_EQ(emitted_.size(), 1U);
  EXPECT_EQ(emitted_[0].stamp_ns, 2);
  EXPECT_TRUE(emitted_[0].has_labels);
}

TEST_F(ScanPairingTest, PassesScansOnWhereNoLabelsCome) {
  for (std::int64_t stamp = 0; stamp < 20; ++stamp) pairing_.take(scan_at(stamp));
  EXPECT_EQ(emitted_.size(), 20U - ScanPairing::kMostWaiting);
  EXPECT_FALSE(emitted_[0].has_labels);
}

TEST(LabelledPoints, LeaveOutBeamsWithoutEcho) {
  flow::LocalizedScan scan = scan_at(1'500'000'000);
  scan.beams.resize(3);
  scan.beams[1].range_m = 5.0F;
  scan.beams[1].point_in_base_m = {3.0F, 4.0F};
  const auto message = labelled_points_message(
      scan, {flow::PointLabel::kNoEcho, flow::PointLabel::kMoving, flow::PointLabel::kNoEcho});
  ASSERT_EQ(message.data().size(), kPointStride);
  EXPECT_EQ(message.data()[12], static_cast<char>(flow::PointLabel::kMoving));
  EXPECT_EQ(message.timestamp().seconds(), 1);
  EXPECT_EQ(message.timestamp().nanos(), 500'000'000);
}

TEST(Scene, DeletesTracksThatAreGone) {
  flow::TrackedObjects objects;
  objects.objects.resize(2);
  objects.objects[0].track_id = {5};
  objects.objects[0].confirmed = true;
  objects.objects[1].track_id = {6};
  const auto message = scene_message(objects, {{5}, {4}});
  ASSERT_EQ(message.entities_size(), 1);
  EXPECT_EQ(message.entities(0).id(), "track_5");
  ASSERT_EQ(message.deletions_size(), 1);
  EXPECT_EQ(message.deletions(0).id(), "track_4");
}

}  // namespace
}  // namespace slammot::gateway
