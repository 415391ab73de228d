#include "services/tracking/tracking_journal.hpp"

#include <gtest/gtest.h>

#include "common/memory/byte_stream.hpp"

namespace slammot::tracking {
namespace {

flow::SegmentedScan empty_scan() {
  flow::SegmentedScan scan;
  scan.stamp_ns = 17;
  scan.scanner_id = "front";
  scan.range_m.assign(10, 0.0F);
  scan.points_in_base_m.assign(10, Eigen::Vector2f::Zero());
  scan.labels.assign(10, flow::PointLabel::kNoEcho);
  scan.beam_step_rad = 0.01;
  return scan;
}

Session example(Tracker& tracker) {
  Session session{{{3}, {4}}, {}};
  session.last_results["front"] = tracker.step(empty_scan());
  session.last_results["front"].objects.objects.resize(2);
  session.last_results["front"].objects.objects.back().length_m = 4.5;
  session.last_results["front"].objects.objects.back().predicted_path.resize(3);
  return session;
}

TEST(TrackingJournal, GivesBackTheFrameTheAnswersAndTheTracker) {
  Tracker tracker({}), next({});
  const Session session = example(tracker);
  const auto restored = restore(to_bytes(session, tracker), next);
  ASSERT_TRUE(restored);
  EXPECT_EQ(restored->frame, session.frame);
  const TrackingResult& answer = restored->last_results.at("front");
  EXPECT_EQ(answer.labels.labels.size(), 10U);
  ASSERT_EQ(answer.objects.objects.size(), 2U);
  EXPECT_EQ(answer.objects.objects.back().length_m, 4.5);
  EXPECT_EQ(answer.objects.objects.back().predicted_path.size(), 3U);
  EXPECT_EQ(to_bytes(*restored, next), to_bytes(session, tracker)) << "the rest, too";
}

TEST(TrackingJournal, RefusesEveryChangedByteAndEveryCut) {
  Tracker tracker({}), next({});
  auto bytes = to_bytes(example(tracker), tracker);
  for (std::size_t i = 0; i < bytes.size(); i += 7) {
    EXPECT_FALSE(restore(std::span(bytes).first(i), next)) << i;
    bytes[i] ^= std::byte{0x10};
    EXPECT_FALSE(restore(bytes, next)) << i;
    bytes[i] ^= std::byte{0x10};
  }
}

}  // namespace
}  // namespace slammot::tracking
