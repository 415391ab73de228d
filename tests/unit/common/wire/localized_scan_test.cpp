#include "common/wire/localized_scan.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

#include "common/wire/sensor.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/values.hpp"

namespace slammot::wire {
namespace {

using slammot::testing::kNan;
using slammot::testing::kNanF;

struct LocalizedScanOnTheWire : ::testing::Test {
  testing::Random random{1};
  flow::LocalizedScan scan = testing::localized_scan(random, 181);
  LocalizedScanEncoder encoder;
  slammot_LocalizedScan sample = encoder.encode("car", scan);
};

TEST_F(LocalizedScanOnTheWire, ComesBackAsItWas) {
  const auto back = decode(sample);
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
  EXPECT_EQ(back->speed_mps, scan.speed_mps);
  EXPECT_EQ(back->yaw_rate_radps, scan.yaw_rate_radps);
  EXPECT_EQ(back->submap_id, scan.submap_id);
  EXPECT_EQ(back->submap_from_base, scan.submap_from_base);
  EXPECT_EQ(back->local_variance_share, scan.local_variance_share);
}

TEST_F(LocalizedScanOnTheWire, BringsItsBeamsBackInTheirOrder) {
  const auto back = decode(sample);
  ASSERT_TRUE(back);
  ASSERT_EQ(back->beams.size(), scan.beams.size());
  for (std::size_t i = 0; i < scan.beams.size(); ++i) {
    EXPECT_EQ(back->beams[i].point_in_base_m, scan.beams[i].point_in_base_m);
    EXPECT_EQ(back->beams[i].range_m, scan.beams[i].range_m);
    EXPECT_EQ(back->beams[i].expected_range_m, scan.beams[i].expected_range_m);
    EXPECT_EQ(back->beams[i].free_evidence, scan.beams[i].free_evidence);
    EXPECT_EQ(back->beams[i].moving_evidence, scan.beams[i].moving_evidence);
    EXPECT_EQ(back->beams[i].end_cell, scan.beams[i].end_cell);
  }
}

TEST_F(LocalizedScanOnTheWire, IsRefusedWhereItIsUnsound) {
  const auto fault_after = [&](auto corrupt) {
    slammot_LocalizedScan corrupted = encoder.encode("car", scan);
    corrupt(corrupted);
    return decode(corrupted).fault();
  };
  EXPECT_EQ(fault_after([](auto&) {}), "");
  EXPECT_NE(fault_after([](auto& s) { s.base_from_laser.heading_rad = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.max_range_m = -1.0; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.sweep_s = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.sweep_s = -1e6; }), "");
  EXPECT_EQ(fault_after([](auto& s) { s.sweep_s = -0.1; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.beam_step_rad = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.odom_from_base.mean.x_m = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.odom_from_base.covariance[4] = -1.0; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.map_from_odom.y_m = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.speed_mps = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.yaw_rate_radps = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.submap_from_base.y_m = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.local_variance_share = 0.0; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.local_variance_share = 1.5; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.beams._buffer[3].point_in_base.x_m = kNanF; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.beams._buffer[3].range_m = -1.0F; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.beams._buffer[3].expected_range_m = kNanF; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.beams._buffer[3].free_evidence = kNanF; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.beams._buffer[3].moving_evidence = 1.5F; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.end_cells._buffer[3] = static_cast<slammot_EndCell>(4); }),
            "");
  EXPECT_NE(fault_after([](auto& s) { --s.end_cells._length; }), "");
}

TEST_F(LocalizedScanOnTheWire, DoesNotTakeMoreBeamsThanFit) {
  scan.beams.resize(kMostBeams + 1);
  EXPECT_THROW(encoder.encode("car", scan), std::length_error);
}

}  // namespace
}  // namespace slammot::wire
