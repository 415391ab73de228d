#include "common/files/record_traffic.hpp"

#include <gtest/gtest.h>

namespace slammot::files {
namespace {

using traffic::Mover;

flow::TrackedObject object_at(std::uint32_t id, double x_m) {
  flow::TrackedObject object;
  object.track_id = {id};
  object.confirmed = true;
  object.position_in_odom_m = {x_m, 2.0};
  object.velocity_in_odom_mps = {10.0, 0.0};
  object.covariance = 0.01 * Eigen::Matrix4d::Identity();
  object.width_m = 2.0;
  object.class_probability = {0.1, 0.0, 0.7, 0.2};
  return object;
}

/// A drive of 3 s along x in one submap, with one car beside the vehicle.
class RecordTraffic : public ::testing::Test {
 protected:
  void drive(const std::function<void(int scan, flow::TrackedObject& object)>& change = {}) {
    for (int scan = 0; scan <= 30; ++scan) {
      const std::int64_t stamp_ns = scan * 100'000'000LL;
      record_.add_scan(stamp_ns);
      flow::LocalizedScan localized;
      localized.stamp_ns = stamp_ns;
      localized.odom_from_base.pose = localized.submap_from_base = {1.0 * scan, 0.0, 0.0};
      record_.add(localized);
      flow::TrackedObjects tracked;
      tracked.stamp_ns = stamp_ns;
      tracked.objects.push_back(object_at(7, 1.0 * scan));
      if (change) change(scan, tracked.objects.front());
      record_.add(tracked);
    }
  }

  RunRecord record_;
};

TEST_F(RecordTraffic, HoldsEachTrackWithItsLikeliestKind) {
  drive([](int scan, flow::TrackedObject& object) {
    if (scan < 5) object.class_probability = {0.9, 0.1, 0.0, 0.0};  // a first guess
  });
  const auto passages = passages_of(record_);
  ASSERT_EQ(passages.size(), 1U);
  EXPECT_EQ(passages[0].mover, Mover::kVehicle);
  EXPECT_EQ(passages[0].states.size(), 31U);
  EXPECT_NEAR(passages[0].width_m, 2.0, 1e-9);
}

TEST_F(RecordTraffic, LeavesOutStatesThatArePredictedOrStopped) {
  drive([](int scan, flow::TrackedObject& object) {
    object.occluded = scan < 10;
    if (scan >= 20) object.motion = flow::Motion::kStopped;
  });
  EXPECT_EQ(passages_of(record_).at(0).states.size(), 10U);
}

TEST_F(RecordTraffic, LeavesOutTracksWithoutClass) {
  drive([](int, flow::TrackedObject& object) { object.class_probability = {}; });
  EXPECT_TRUE(passages_of(record_).empty());
}

TEST_F(RecordTraffic, PlacesTracksByTheCorrectedTrajectory) {
  drive();
  record_.add(flow::GraphCorrection{1, {}, {{{0}, {100.0, 50.0, 0.5 * 3.14159265358979}}}});
  const auto state = passages_of(record_).at(0).states.at(10);  // at (10, 2) as published live
  EXPECT_NEAR(state.position_in_map_m.x(), 98.0, 1e-6);
  EXPECT_NEAR(state.position_in_map_m.y(), 60.0, 1e-6);
  EXPECT_NEAR(state.velocity_in_map_mps.x(), 0.0, 1e-6);
  EXPECT_NEAR(state.velocity_in_map_mps.y(), 10.0, 1e-6);
}

TEST_F(RecordTraffic, BecomesALaneOfTheFile) {
  drive();
  const std::string lanes = lanes_geojson(record_);
  EXPECT_NE(lanes.find(R"("kind":"lane")"), std::string::npos);
  EXPECT_EQ(lanes.find(R"("kind":"walkway")"), std::string::npos);
  EXPECT_EQ(lanes, lanes_geojson(record_));
}

}  // namespace
}  // namespace slammot::files
