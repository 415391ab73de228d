#include "common/wire/truth.hpp"

#include <gtest/gtest.h>

#include "common/wire/text.hpp"
#include "tests/support/values.hpp"

namespace slammot::wire {
namespace {

using slammot::testing::kNan;

struct TruthOnTheWire : ::testing::Test {
  TruthOnTheWire() {
    scan.scan = testing::laser_scan(random, 5);
    scan.world_from_base = testing::pose(random);
    scan.speed_mps = 3.0;
    scan.yaw_rate_radps = -0.2;
    scan.nose_down_rad = 0.03;
    scan.objects = {
        {7, simulation::ObjectClass::bus, {12.0, 2.5}, testing::pose(random), 4.0, 2, 30.0}};
    scan.unseen = {
        {3, simulation::ObjectClass::pedestrian, {0.5, 0.6}, testing::pose(random), 1.0, 0, 60.0}};
    scan.hits = {0, 7, 7, -1, -2};
  }
  testing::Random random{1};
  simulation::SimulatedScan scan;
  TruthEncoder encoder{99};
};

TEST_F(TruthOnTheWire, HasThePose) {
  const slammot_TruePose& sample = encoder.encode_pose("car", scan);
  EXPECT_EQ(sample.drive_id, 99U);
  const auto back = decode(sample);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->stamp_ns, scan.scan.stamp_ns);
  EXPECT_EQ(back->world_from_base, scan.world_from_base);
  EXPECT_EQ(back->speed_mps, 3.0);
  EXPECT_EQ(back->yaw_rate_radps, -0.2);
  EXPECT_EQ(back->nose_down_rad, 0.03);
}

TEST_F(TruthOnTheWire, HasTheSeenAndTheUnseenByTheirIds) {
  const slammot_TrueObjects& sample = encoder.encode_objects("car", scan);
  EXPECT_EQ(sample.drive_id, 99U);
  const auto back = decode(sample);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->sequence, scan.scan.sequence);
  EXPECT_EQ(back->scanner_id, scan.scan.scanner.scanner_id);
  ASSERT_EQ(back->objects.size(), 2U);
  const simulation::ObjectTruth& bus = back->objects[1];
  EXPECT_EQ(back->objects[0].id, 3);
  EXPECT_EQ(bus.id, 7);
  EXPECT_EQ(bus.kind, simulation::ObjectClass::bus);
  EXPECT_EQ(bus.size.length_m, 12.0);
  EXPECT_EQ(bus.size.width_m, 2.5);
  EXPECT_EQ(bus.world_from_object, scan.objects[0].world_from_object);
  EXPECT_EQ(bus.speed_mps, 4.0);
  EXPECT_EQ(bus.points, 2);
  EXPECT_EQ(bus.range_m, 30.0);
}

TEST_F(TruthOnTheWire, LeavesOutTheFarthestOfTooMany) {
  scan.unseen.clear();
  for (int i = 0; i < 2000; ++i)
    scan.unseen.push_back(
        {10 + i, simulation::ObjectClass::car, {4.5, 1.8}, {}, 0.0, 0, 2000.0 - i});
  const auto back = decode(encoder.encode_objects("car", scan));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->objects.size(), kMostTrueObjects);
  for (const auto& object : back->objects) EXPECT_LE(object.range_m, 1500.0);
}

TEST_F(TruthOnTheWire, SaysWhatEachBeamHit) {
  const slammot_TrueHits& sample = encoder.encode_hits("car", scan);
  EXPECT_EQ(sample.drive_id, 99U);
  const auto back = decode(sample);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->stamp_ns, scan.scan.stamp_ns);
  EXPECT_EQ(back->hits, scan.hits);
}

TEST_F(TruthOnTheWire, IsRefusedWhereItIsUnsound) {
  slammot_TruePose pose = encoder.encode_pose("car", scan);
  pose.world_from_base.x_m = kNan;
  EXPECT_FALSE(decode(pose));
  pose = encoder.encode_pose("car", scan);
  pose.speed_mps = kNan;
  EXPECT_FALSE(decode(pose));
  scan.objects[0].size.length_m = -1.0;
  EXPECT_FALSE(decode(encoder.encode_objects("car", scan)));
  scan.objects[0] = {7, static_cast<simulation::ObjectClass>(9), {1.0, 1.0}, {}, 0.0, 1, 1.0};
  EXPECT_FALSE(decode(encoder.encode_objects("car", scan)));
  scan.hits = {-3};
  EXPECT_FALSE(decode(encoder.encode_hits("car", scan)));
}

}  // namespace
}  // namespace slammot::wire
