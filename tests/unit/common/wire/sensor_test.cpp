#include "common/wire/sensor.hpp"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/wire/text.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/values.hpp"

namespace slammot::wire {
namespace {

using slammot::testing::kNan;
using slammot::testing::kNanF;

struct LaserScanOnTheWire : ::testing::Test {
  testing::Random random{1};
  sensing::LaserScan scan = testing::laser_scan(random, 181);
  LaserScanEncoder encoder;
  slammot_LaserScan sample = encoder.encode("car", scan);
};

TEST_F(LaserScanOnTheWire, ComesBackAsItWas) {
  const auto back = decode(sample);
  ASSERT_TRUE(back) << back.fault();
  EXPECT_EQ(back->stamp_ns, scan.stamp_ns);
  EXPECT_EQ(back->sequence, scan.sequence);
  EXPECT_EQ(back->scanner.scanner_id, scan.scanner.scanner_id);
  EXPECT_EQ(back->scanner.base_from_laser, scan.scanner.base_from_laser);
  EXPECT_EQ(back->scanner.first_beam_rad, scan.scanner.first_beam_rad);
  EXPECT_EQ(back->scanner.beam_step_rad, scan.scanner.beam_step_rad);
  EXPECT_EQ(back->scanner.max_range_m, scan.scanner.max_range_m);
  EXPECT_EQ(back->scanner.sweep_s, scan.scanner.sweep_s);
  EXPECT_EQ(back->range_m, scan.range_m);
  EXPECT_TRUE(is_about(sample, "car"));
  EXPECT_FALSE(is_about(sample, "ca"));
}

TEST_F(LaserScanOnTheWire, KeepsReadingsThatAreNoEchoes) {
  scan.range_m = {kNanF, -1.0F, 0.0F, std::numeric_limits<float>::infinity(), 100.0F};
  const auto back = decode(encoder.encode("car", scan));
  ASSERT_TRUE(back);
  EXPECT_THAT(back->range_m, ::testing::Pointwise(::testing::NanSensitiveFloatEq(), scan.range_m));
}

TEST_F(LaserScanOnTheWire, IsRefusedWhereItIsUnsound) {
  const auto fault_after = [&](auto corrupt) {
    slammot_LaserScan corrupted = sample;
    corrupt(corrupted);
    return decode(corrupted).fault();
  };
  EXPECT_NE(fault_after([](auto& s) { s.base_from_laser.x_m = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.first_beam_rad = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.beam_step_rad = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.max_range_m = 0.0; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.max_range_m = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.sweep_s = -0.1; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.sweep_s = 1e6; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.ranges_m._length = 0; }), "");
}

TEST_F(LaserScanOnTheWire, DoesNotTakeMoreBeamsThanFit) {
  scan.range_m.resize(kMostBeams + 1);
  EXPECT_THROW(encoder.encode("car", scan), std::length_error);
}

TEST_F(LaserScanOnTheWire, UsesTheSameMemoryAgain) {
  const float* const buffer = encoder.encode("car", scan).ranges_m._buffer;
  scan.range_m.resize(90);
  EXPECT_EQ(encoder.encode("car", scan).ranges_m._buffer, buffer);
}

TEST(OdometryOnTheWire, ComesBackAsItWas) {
  const sensing::Odometry odometry{123, {1.0, -2.0, 3.0}};
  const auto back = decode(encode("car", odometry));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->stamp_ns, 123);
  EXPECT_EQ(back->wheel_from_base, odometry.wheel_from_base);
}

TEST(OdometryOnTheWire, IsRefusedWhereItIsNotFinite) {
  EXPECT_NE(decode(encode("car", sensing::Odometry{123, {1.0, kNan, 3.0}})).fault(), "");
}

struct GnssFixOnTheWire : ::testing::Test {
  sensing::GnssFix fix{123,           "roof", sensing::GnssQuality::differential,
                       {40.1, -79.2}, 231.0,  geometry::Matrix2{{4.0, 1.0}, {1.0, 9.0}},
                       1.5,           9};
};

TEST_F(GnssFixOnTheWire, ComesBackAsItWas) {
  const auto back = decode(encode("car", fix));
  ASSERT_TRUE(back) << back.fault();
  EXPECT_EQ(back->stamp_ns, 123);
  EXPECT_EQ(back->receiver_id, "roof");
  EXPECT_EQ(back->quality, sensing::GnssQuality::differential);
  EXPECT_EQ(back->position.latitude_deg, 40.1);
  EXPECT_EQ(back->position.longitude_deg, -79.2);
  EXPECT_EQ(back->altitude_m, 231.0);
  EXPECT_EQ(back->covariance_m2, fix.covariance_m2);
  EXPECT_EQ(back->hdop, 1.5);
  EXPECT_EQ(back->satellites, 9);
}

TEST_F(GnssFixOnTheWire, IsRefusedWhereItIsUnsound) {
  const auto fault_after = [&](auto corrupt) {
    slammot_GnssFix sample = encode("car", fix);
    corrupt(sample);
    return decode(sample).fault();
  };
  EXPECT_NE(fault_after([](auto& s) { s.latitude_deg = 91.0; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.longitude_deg = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.altitude_m = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.hdop = -1.0; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.covariance_m2[3] = -1.0; }), "");
  EXPECT_NE(fault_after([](auto& s) { reinterpret_cast<std::uint32_t&>(s.quality) = 77; }), "");
  EXPECT_EQ(
      fault_after([](auto& s) { s.quality = slammot_GNSS_QUALITY_NO_FIX, s.latitude_deg = kNan; }),
      "");  // means nothing then
}

TEST(CompassReadingOnTheWire, ComesBackAsItWasIfItIsSound) {
  const auto back = decode(encode("car", sensing::CompassReading{123, "bow", 1.5, 0.1}));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->stamp_ns, 123);
  EXPECT_EQ(back->compass_id, "bow");
  EXPECT_EQ(back->heading_from_east_rad, 1.5);
  EXPECT_EQ(back->sigma_rad, 0.1);
  EXPECT_FALSE(decode(encode("car", sensing::CompassReading{123, "bow", kNan, 0.1})));
  EXPECT_FALSE(decode(encode("car", sensing::CompassReading{123, "bow", 1.0, -0.1})));
}

}  // namespace
}  // namespace slammot::wire
