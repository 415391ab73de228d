#include "common/wire/scan_labels.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

#include "common/wire/sensor.hpp"

namespace slammot::wire {
namespace {

using flow::PointLabel;

struct ScanLabelsOnTheWire : ::testing::Test {
  flow::ScanLabels labels{.stamp_ns = 1'700'000'000'123'456'789,
                          .sequence = 42,
                          .scanner_id = "rear",
                          .labels = {PointLabel::kMoving, PointLabel::kNoEcho,
                                     PointLabel::kStationary, PointLabel::kUnknown},
                          .restored = {{40, {1, 2, 3}}, {38, {}}, {41, {7}}}};
  ScanLabelsEncoder encoder;
};

TEST_F(ScanLabelsOnTheWire, ComeBackAsTheyWere) {
  const auto back = decode(encoder.encode("car", labels));
  ASSERT_TRUE(back) << back.fault();
  EXPECT_EQ(back->stamp_ns, labels.stamp_ns);
  EXPECT_EQ(back->sequence, labels.sequence);
  EXPECT_EQ(back->scanner_id, labels.scanner_id);
  EXPECT_EQ(back->labels, labels.labels);
  ASSERT_EQ(back->restored.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(back->restored[i].sequence, labels.restored[i].sequence);
    EXPECT_EQ(back->restored[i].beams, labels.restored[i].beams);
  }
}

TEST_F(ScanLabelsOnTheWire, LeaveRestoredScansBehindThatDoNotFit) {
  labels.restored.assign(70, {1, {1}});
  EXPECT_EQ(decode(encoder.encode("car", labels))->restored.size(), kMostRestoredScans);
  labels.restored.assign(20, {1, std::vector<std::uint16_t>(4000, 5)});
  EXPECT_EQ(decode(encoder.encode("car", labels))->restored.size(), kMostRestoredPoints / 4000);
}

TEST_F(ScanLabelsOnTheWire, AreRefusedWhereTheyAreUnsound) {
  const auto fault_after = [&](auto corrupt) {
    slammot_ScanLabels corrupted = encoder.encode("car", labels);
    corrupt(corrupted);
    return decode(corrupted).fault();
  };
  EXPECT_EQ(fault_after([](auto&) {}), "");
  EXPECT_NE(fault_after([](auto& s) { s.labels._buffer[0] = static_cast<slammot_PointLabel>(4); }),
            "");
  EXPECT_NE(fault_after([](auto& s) { --s.restored_beams._length; }), "");
  EXPECT_NE(fault_after([](auto& s) { ++s.restored_scans._buffer[0].beam_count; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.restored_beams._buffer[0] = kMostBeams; }), "");
}

TEST_F(ScanLabelsOnTheWire, AreNotMoreThanFit) {
  labels.labels.resize(kMostBeams + 1);
  EXPECT_THROW(encoder.encode("car", labels), std::length_error);
}

}  // namespace
}  // namespace slammot::wire
