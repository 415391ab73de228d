#include "common/wire/segmented_scan.hpp"

#include <algorithm>
#include <stdexcept>

#include <gtest/gtest.h>

#include "common/wire/sensor.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/values.hpp"

namespace slammot::wire {
namespace {

using slammot::testing::kNan;
using slammot::testing::kNanF;

struct SegmentedScanOnTheWire : ::testing::Test {
  testing::Random random{1};
  flow::SegmentedScan scan = testing::segmented_scan(random, 181);
  SegmentedScanEncoder encoder;
};

void expect_same(const flow::Segment& a, const flow::Segment& b) {
  EXPECT_EQ(a.segment_id, b.segment_id);
  EXPECT_EQ(a.label, b.label);
  EXPECT_EQ(a.beams, b.beams);
  EXPECT_EQ(a.centroid_in_odom_m, b.centroid_in_odom_m);
  EXPECT_EQ(a.centroid_covariance_m2, b.centroid_covariance_m2);
  EXPECT_EQ(a.box_centre_in_odom_m, b.box_centre_in_odom_m);
  EXPECT_EQ(a.box_heading_rad, b.box_heading_rad);
  EXPECT_EQ(a.box_length_m, b.box_length_m);
  EXPECT_EQ(a.box_width_m, b.box_width_m);
  EXPECT_EQ(a.moving_share, b.moving_share);
  EXPECT_EQ(a.occluded_at_start, b.occluded_at_start);
  EXPECT_EQ(a.occluded_at_end, b.occluded_at_end);
}

TEST_F(SegmentedScanOnTheWire, ComesBackAsItWas) {
  const auto back = decode(encoder.encode("car", scan));
  ASSERT_TRUE(back) << back.fault();
  EXPECT_EQ(back->stamp_ns, scan.stamp_ns);
  EXPECT_EQ(back->sequence, scan.sequence);
  EXPECT_EQ(back->scanner_id, scan.scanner_id);
  EXPECT_EQ(back->base_from_laser, scan.base_from_laser);
  EXPECT_EQ(back->max_range_m, scan.max_range_m);
  EXPECT_EQ(back->beam_step_rad, scan.beam_step_rad);
  EXPECT_EQ(back->sweep_s, scan.sweep_s);
  EXPECT_EQ(back->odom_from_base.pose, scan.odom_from_base.pose);
  EXPECT_EQ(back->odom_from_base.covariance, scan.odom_from_base.covariance);
  EXPECT_EQ(back->map_from_odom, scan.map_from_odom);
  EXPECT_EQ(back->map_id, scan.map_id);
  EXPECT_EQ(back->odom_id, scan.odom_id);
  EXPECT_EQ(back->points_in_base_m, scan.points_in_base_m);
  EXPECT_EQ(back->range_m, scan.range_m);
  EXPECT_EQ(back->labels, scan.labels);
  ASSERT_EQ(back->segments.size(), scan.segments.size());
  for (std::size_t i = 0; i < scan.segments.size(); ++i)
    expect_same(back->segments[i], scan.segments[i]);
}

TEST_F(SegmentedScanOnTheWire, MayHaveNoSegment) {
  scan.segments.clear();
  const auto back = decode(encoder.encode("car", scan));
  ASSERT_TRUE(back);
  EXPECT_TRUE(back->segments.empty());
}

TEST_F(SegmentedScanOnTheWire, KeepsTheLargestSegmentsInTheirOrderWhereNotAllFit) {
  scan = testing::segmented_scan(random, 4000);
  for (std::size_t i = 0; i < scan.segments.size(); ++i) {
    if (i % 7 != 0) scan.segments[i].beams.pop_back();
  }
  const auto back = decode(encoder.encode("car", scan));
  ASSERT_TRUE(back) << back.fault();
  EXPECT_EQ(back->segments.size(), kMostSegments);
  const auto is_large = [](const flow::Segment& segment) { return segment.beams.size() == 2; };
  EXPECT_EQ(std::count_if(back->segments.begin(), back->segments.end(), is_large),
            std::count_if(scan.segments.begin(), scan.segments.end(), is_large));
  EXPECT_TRUE(
      std::is_sorted(back->segments.begin(), back->segments.end(),
                     [](const auto& a, const auto& b) { return a.segment_id < b.segment_id; }));
}

TEST_F(SegmentedScanOnTheWire, IsRefusedWhereItIsUnsound) {
  const auto fault_after = [&](auto corrupt) {
    slammot_SegmentedScan corrupted = encoder.encode("car", scan);
    corrupt(corrupted);
    return decode(corrupted).fault();
  };
  EXPECT_EQ(fault_after([](auto&) {}), "");
  EXPECT_NE(fault_after([](auto& s) { s.base_from_laser.x_m = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.max_range_m = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.sweep_s = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.sweep_s = -1e6; }), "");
  EXPECT_EQ(fault_after([](auto& s) { s.sweep_s = -0.1; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.beam_step_rad = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.odom_from_base.covariance[0] = -1.0; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.map_from_odom.x_m = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { --s.points_in_base._length; }), "");
  EXPECT_NE(fault_after([](auto& s) { --s.labels._length; }), "");
  EXPECT_NE(fault_after([](auto& s) { --s.ranges_m._length; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.points_in_base._buffer[2].y_m = kNanF; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.ranges_m._buffer[2] = -1.0F; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.labels._buffer[2] = static_cast<slammot_PointLabel>(9); }),
            "");
  EXPECT_NE(fault_after([](auto& s) { --s.segment_beams._length; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.segment_beams._buffer[0] = 181; }), "");
  EXPECT_NE(fault_after([](auto& s) { ++s.segments._buffer[0].beam_count; }), "");
  EXPECT_NE(fault_after(
                [](auto& s) { s.segments._buffer[0].label = static_cast<slammot_PointLabel>(9); }),
            "");
  EXPECT_NE(fault_after([](auto& s) { s.segments._buffer[0].centroid_in_odom_m.x = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.segments._buffer[0].centroid_covariance_m2[3] = -1.0; }),
            "");
  EXPECT_NE(fault_after([](auto& s) { s.segments._buffer[0].box_heading_rad = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.segments._buffer[0].box_length_m = -1.0; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.segments._buffer[0].moving_share = 2.0; }), "");
}

TEST_F(SegmentedScanOnTheWire, DoesNotTakeMoreBeamsThanFit) {
  scan.range_m.resize(kMostBeams + 1);
  EXPECT_THROW(encoder.encode("car", scan), std::length_error);
}

}  // namespace
}  // namespace slammot::wire
