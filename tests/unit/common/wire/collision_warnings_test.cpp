#include "common/wire/collision_warnings.hpp"

#include <gtest/gtest.h>

#include "common/dds/serialized_size.hpp"
#include "common/dds/topic_table.hpp"
#include "common/wire/tracked_objects.hpp"
#include "tests/support/values.hpp"

namespace slammot::wire {
namespace {

using flow::WarningLevel;

flow::CollisionWarnings warnings_of(std::uint32_t objects) {
  flow::CollisionWarnings warnings{.stamp_ns = 1'700'000'000'123'456'789,
                                   .sequence = 42,
                                   .map_id = {7},
                                   .odom_id = {3},
                                   .horizon_s = 4.0,
                                   .highest_level = WarningLevel::kWarning,
                                   .objects = {}};
  for (std::uint32_t i = 0; i < objects; ++i)
    warnings.objects.push_back({{i}, WarningLevel::kCaution, 0.3, 1.5, 0.25, 1.25});
  return warnings;
}

TEST(CollisionWarningsOnTheWire, ComeBackAsTheyWere) {
  const flow::CollisionWarnings warnings = warnings_of(3);
  CollisionWarningsEncoder encoder;
  const auto back = decode(encoder.encode("car", warnings));
  ASSERT_TRUE(back) << back.fault();
  EXPECT_EQ(back->stamp_ns, warnings.stamp_ns);
  EXPECT_EQ(back->sequence, warnings.sequence);
  EXPECT_EQ(back->map_id, warnings.map_id);
  EXPECT_EQ(back->odom_id, warnings.odom_id);
  EXPECT_EQ(back->horizon_s, warnings.horizon_s);
  EXPECT_EQ(back->highest_level, warnings.highest_level);
  ASSERT_EQ(back->objects.size(), 3U);
  EXPECT_EQ(back->objects[2].track_id, flow::TrackId{2});
  EXPECT_EQ(back->objects[2].level, WarningLevel::kCaution);
  EXPECT_EQ(back->objects[2].probability, 0.3);
  EXPECT_EQ(back->objects[2].time_to_collision_s, 1.5);
  EXPECT_EQ(back->objects[2].closest_distance_m, 0.25);
  EXPECT_EQ(back->objects[2].time_to_closest_s, 1.25);
}

TEST(CollisionWarningsOnTheWire, KeepTheMostUrgentOfTooMany) {
  flow::CollisionWarnings warnings = warnings_of(300);
  warnings.objects[298].probability = 0.9;
  warnings.objects[299].level = WarningLevel::kWarning;
  CollisionWarningsEncoder encoder;
  const slammot_CollisionWarnings& sample = encoder.encode("car", warnings);
  const auto back = decode(sample);
  ASSERT_EQ(back->objects.size(), kMostObjects);
  EXPECT_EQ(back->objects[0].track_id, flow::TrackId{299});
  EXPECT_EQ(back->objects[1].track_id, flow::TrackId{298});
  EXPECT_LE(dds::serialized_bytes(dds::topics::kCollisionWarnings, sample), 128U * 1024U);
}

TEST(CollisionWarningsOnTheWire, AreRefusedWhereTheyAreUnsound) {
  const auto fault_after = [](auto corrupt) {
    CollisionWarningsEncoder encoder;
    const flow::CollisionWarnings warnings = warnings_of(1);
    slammot_CollisionWarnings sample = encoder.encode("car", warnings);
    corrupt(sample, sample.objects._buffer[0]);
    return decode(sample).fault();
  };
  const auto unknown = static_cast<slammot_WarningLevel>(3);
  EXPECT_EQ(fault_after([](auto&, auto&) {}), "");
  EXPECT_NE(fault_after([](auto& s, auto&) { s.horizon_s = testing::kNan; }), "");
  EXPECT_NE(fault_after([&](auto& s, auto&) { s.highest_level = unknown; }), "");
  EXPECT_NE(fault_after([&](auto&, auto& o) { o.level = unknown; }), "");
  EXPECT_NE(fault_after([](auto&, auto& o) { o.probability = 1.1; }), "");
  EXPECT_NE(fault_after([](auto&, auto& o) { o.time_to_collision_s = testing::kNan; }), "");
  EXPECT_NE(fault_after([](auto&, auto& o) { o.closest_distance_m = -0.1; }), "");
}

}  // namespace
}  // namespace slammot::wire
