#include "common/wire/tracked_objects.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"
#include "tests/support/values.hpp"

namespace slammot::wire {
namespace {

using slammot::testing::kNan;
using slammot::testing::kNanF;

struct TrackedObjectsOnTheWire : ::testing::Test {
  testing::Random random{1};
  flow::TrackedObjects objects = testing::tracked_objects(random, 10);
  TrackedObjectsEncoder encoder;
};

void expect_same(const flow::TrackedObject& a, const flow::TrackedObject& b) {
  EXPECT_EQ(a.track_id, b.track_id);
  EXPECT_EQ(a.confirmed, b.confirmed);
  EXPECT_EQ(a.occluded, b.occluded);
  EXPECT_EQ(a.existence, b.existence);
  EXPECT_EQ(a.position_in_odom_m, b.position_in_odom_m);
  EXPECT_EQ(a.velocity_in_odom_mps, b.velocity_in_odom_mps);
  EXPECT_EQ(a.covariance, b.covariance);
  EXPECT_EQ(a.acceleration_in_odom_mps2, b.acceleration_in_odom_mps2);
  EXPECT_EQ(a.heading_in_odom_rad, b.heading_in_odom_rad);
  EXPECT_EQ(a.length_m, b.length_m);
  EXPECT_EQ(a.width_m, b.width_m);
  EXPECT_EQ(a.motion, b.motion);
  EXPECT_EQ(a.object_class, b.object_class);
  EXPECT_EQ(a.mode_probability, b.mode_probability);
  EXPECT_EQ(a.class_probability, b.class_probability);
  EXPECT_EQ(a.first_seen_ns, b.first_seen_ns);
  EXPECT_EQ(a.last_seen_ns, b.last_seen_ns);
  EXPECT_EQ(a.contour_in_odom_m, b.contour_in_odom_m);
  ASSERT_EQ(a.predicted_path.size(), b.predicted_path.size());
  for (std::size_t i = 0; i < a.predicted_path.size(); ++i) {
    EXPECT_EQ(a.predicted_path[i].after_s, b.predicted_path[i].after_s);
    EXPECT_EQ(a.predicted_path[i].position_in_odom_m, b.predicted_path[i].position_in_odom_m);
    EXPECT_EQ(a.predicted_path[i].covariance_m2, b.predicted_path[i].covariance_m2);
  }
}

TEST_F(TrackedObjectsOnTheWire, ComeBackAsTheyWere) {
  const auto back = decode(encoder.encode("car", objects));
  ASSERT_TRUE(back) << back.fault();
  EXPECT_EQ(back->stamp_ns, objects.stamp_ns);
  EXPECT_EQ(back->sequence, objects.sequence);
  EXPECT_EQ(back->map_from_odom, objects.map_from_odom);
  EXPECT_EQ(back->map_id, objects.map_id);
  EXPECT_EQ(back->odom_id, objects.odom_id);
  EXPECT_EQ(back->odom_from_base, objects.odom_from_base);
  ASSERT_EQ(back->objects.size(), objects.objects.size());
  for (std::size_t i = 0; i < objects.objects.size(); ++i)
    expect_same(back->objects[i], objects.objects[i]);
}

TEST_F(TrackedObjectsOnTheWire, MayBeNone) {
  objects.objects.clear();
  const auto back = decode(encoder.encode("car", objects));
  ASSERT_TRUE(back);
  EXPECT_TRUE(back->objects.empty());
}

TEST_F(TrackedObjectsOnTheWire, KeepFullContoursAndPathsWhereTheyAreFew) {
  objects = testing::tracked_objects(random, 48, kMostContourPoints, kMostPredictedPositions);
  const auto back = decode(encoder.encode("car", objects));
  ASSERT_TRUE(back);
  expect_same(back->objects.back(), objects.objects.back());
}

TEST_F(TrackedObjectsOnTheWire, ShareTheRoomForContoursWhereTheyAreMany) {
  objects = testing::tracked_objects(random, 192, kMostContourPoints, kMostPredictedPositions);
  const auto back = decode(encoder.encode("car", objects));
  ASSERT_TRUE(back) << back.fault();
  ASSERT_EQ(back->objects.size(), 192U);
  for (std::size_t i = 0; i < 192; ++i) {
    // Every fourth point, and the nearest part of the path.
    ASSERT_EQ(back->objects[i].contour_in_odom_m.size(), 16U);
    EXPECT_EQ(back->objects[i].contour_in_odom_m[1], objects.objects[i].contour_in_odom_m[4]);
    ASSERT_EQ(back->objects[i].predicted_path.size(), 4U);
    EXPECT_EQ(back->objects[i].predicted_path[3].after_s,
              objects.objects[i].predicted_path[3].after_s);
  }
}

TEST_F(TrackedObjectsOnTheWire, LoseTheLeastLikelyTentativeOnesFirst) {
  objects = testing::tracked_objects(random, 300);
  const auto back = decode(encoder.encode("car", objects));
  ASSERT_TRUE(back) << back.fault();
  EXPECT_EQ(back->objects.size(), kMostObjects);
  const auto is_confirmed = [](const flow::TrackedObject& object) { return object.confirmed; };
  EXPECT_EQ(std::count_if(back->objects.begin(), back->objects.end(), is_confirmed), 150);
}

TEST_F(TrackedObjectsOnTheWire, AreRefusedWhereTheyAreUnsound) {
  const auto fault_after = [&](auto corrupt) {
    slammot_TrackedObjects corrupted = encoder.encode("car", objects);
    corrupt(corrupted);
    return decode(corrupted).fault();
  };
  EXPECT_EQ(fault_after([](auto&) {}), "");
  EXPECT_NE(fault_after([](auto& s) { s.map_from_odom.x_m = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.odom_from_base.x_m = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.objects._buffer[0].existence = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.objects._buffer[0].position_in_odom_m.x = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.objects._buffer[0].velocity_in_odom_mps.y = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.objects._buffer[0].covariance[5] = -1.0; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.objects._buffer[0].acceleration_in_odom_mps2.y = kNan; }),
            "");
  EXPECT_NE(fault_after([](auto& s) { s.objects._buffer[0].heading_in_odom_rad = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.objects._buffer[0].length_m = -1.0; }), "");
  EXPECT_NE(fault_after([](auto& s) {
              s.objects._buffer[0].motion_state = static_cast<slammot_Motion>(2);
            }),
            "");
  EXPECT_NE(fault_after([](auto& s) {
              s.objects._buffer[0].object_class = static_cast<slammot_ObjectClass>(5);
            }),
            "");
  EXPECT_NE(fault_after([](auto& s) { s.objects._buffer[0].mode_probability[2] = -0.5; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.objects._buffer[0].class_probability[1] = 1.5; }), "");
  EXPECT_NE(fault_after([](auto& s) { ++s.objects._buffer[0].contour_count; }), "");
  EXPECT_NE(fault_after([](auto& s) { ++s.objects._buffer[0].path_count; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.contour_points._buffer[0].x_m = kNanF; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.path_points._buffer[0].after_s = -1.0; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.path_points._buffer[0].covariance_m2[0] = -1.0; }), "");
}

}  // namespace
}  // namespace slammot::wire
