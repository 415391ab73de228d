#include "common/traffic/traffic_collector.hpp"

#include <functional>

#include <gtest/gtest.h>

#include "tests/unit/common/traffic/tracked_car.hpp"

namespace slammot::traffic {
namespace {

double length_of(const std::vector<FreeStream>& streams, Mover mover = Mover::kVehicle) {
  double length_m = 0.0;
  for (const FreeStream& stream : streams) {
    if (stream.mover == mover) length_m += static_cast<double>(stream.length_m);
  }
  return length_m;
}

class CollectorTest : public ::testing::Test {
 protected:
  using Change = std::function<void(int scan, flow::TrackedObjects& objects)>;

  void drive(int from_scan, int to_scan, const Change& change = {}) {
    for (int scan = from_scan; scan <= to_scan; ++scan) {
      flow::TrackedObjects objects = car_at_scan(scan);
      if (change) change(scan, objects);
      collector_.add(objects);
    }
  }

  TrafficCollector collector_;
};

TEST_F(CollectorTest, HandsOverWhatMovedInTheFrameOfTheSubmap) {
  drive(0, 30);
  const auto streams = collector_.take(submap_until(30, 0, {10.0, 2.0, M_PI / 2.0}));
  EXPECT_NEAR(length_of(streams), 30.0, 1e-3);
  for (const FreeStream& stream : streams) {
    EXPECT_NEAR(stream.position_m.x(), 0.0F, 1e-4F);
    EXPECT_LT(stream.direction_sum.y(), 0.0F) << "along x of odom, which is -y of the submap";
    EXPECT_NEAR(stream.speed_sum_mps / stream.weight, 10.0F, 1e-3F);
    EXPECT_NEAR(stream.width_sum_m / stream.weight, 1.8F, 1e-3F);
  }
}

TEST_F(CollectorTest, SplitsATrackBetweenSubmapsWithoutLoss) {
  drive(0, 40);
  const auto first = collector_.take(submap_until(15, 0));
  drive(41, 60);
  const auto second = collector_.take(submap_until(60, 1));
  EXPECT_NEAR(length_of(first), 15.0, 1e-3);
  EXPECT_NEAR(length_of(second), 45.0, 1e-3);
  EXPECT_TRUE(collector_.take(submap_until(60, 2)).empty()) << "it is taken once";
}

TEST_F(CollectorTest, KeepsThePartOfASlowTrackThatHasNotGoneFarYet) {
  const auto slowly = [](int scan, flow::TrackedObjects& objects) {
    objects.objects[0].position_in_odom_m.x() = 0.1 * scan;
    objects.objects[0].velocity_in_odom_mps = {1.0, 0.0};
  };
  drive(0, 20, slowly);
  EXPECT_TRUE(collector_.take(submap_until(20, 0)).empty()) << "it may be an error of the box";
  drive(21, 60, slowly);
  EXPECT_NEAR(length_of(collector_.take(submap_until(60, 1))), 6.0, 0.3);
}

TEST_F(CollectorTest, LeavesOutWhatIsTentativeOccludedOrStopped) {
  for (int kind = 0; kind < 3; ++kind) {
    collector_ = {};
    drive(0, 30, [&](int, flow::TrackedObjects& objects) {
      if (kind == 0) objects.objects[0].confirmed = false;
      if (kind == 1) objects.objects[0].occluded = true;
      if (kind == 2) objects.objects[0].motion = flow::Motion::kStopped;
    });
    EXPECT_TRUE(collector_.take(submap_until(30, 0)).empty()) << kind;
  }
}

TEST_F(CollectorTest, DecidesTheKindByAllScans) {
  drive(0, 30, [](int scan, flow::TrackedObjects& objects) {
    if (scan < 5) objects.objects[0].class_probability = {0.9, 0.1, 0.0, 0.0};  // a first guess
  });
  const auto streams = collector_.take(submap_until(30, 0));
  EXPECT_NEAR(length_of(streams, Mover::kVehicle), 30.0, 1e-3);
  EXPECT_EQ(length_of(streams, Mover::kPedestrian), 0.0);
}

TEST_F(CollectorTest, HandsOverTracksThatEnded) {
  drive(0, 10);
  drive(11, 40, [](int, flow::TrackedObjects& objects) { objects.objects.clear(); });
  EXPECT_NEAR(length_of(collector_.take(submap_until(40, 0))), 10.0, 1e-3);
}

TEST_F(CollectorTest, ShowsTracksThatEndedBeforeTheSubmapDoes) {
  drive(0, 10);
  EXPECT_EQ(collector_.parts(), 0U);
  drive(11, 40, [](int, flow::TrackedObjects& objects) { objects.objects.clear(); });
  EXPECT_EQ(collector_.parts(), 1U);
  EXPECT_NEAR(length_of(collector_.waiting()), 10.0, 1e-3);
  EXPECT_NEAR(length_of(collector_.take(submap_until(40, 0))), 10.0, 1e-3) << "they are not taken";
}

TEST_F(CollectorTest, ForgetsAllWithAnotherFrameOdom) {
  drive(0, 30);
  drive(31, 32, [](int, flow::TrackedObjects& objects) { objects.odom_id = {99}; });
  EXPECT_TRUE(collector_.take(submap_until(32, 0)).empty());
}

TEST_F(CollectorTest, HasNothingForASubmapOfAnotherMapOrBeforeIt) {
  drive(20, 50);
  drive(51, 65, [](int, flow::TrackedObjects& objects) { objects.objects.clear(); });
  flow::Submap of_other_map = submap_until(65, 0);
  of_other_map.map_id = {1};
  EXPECT_TRUE(collector_.take(of_other_map).empty());
  EXPECT_TRUE(collector_.take(submap_until(10, 0)).empty());
  EXPECT_NEAR(length_of(collector_.take(submap_until(65, 1))), 30.0, 1e-3);
}

TEST_F(CollectorTest, IgnoresARepeatedStampAndTakesEarlierOnesAsAnotherTrack) {
  drive(0, 30);
  collector_.add(car_at_scan(30));
  drive(0, 30);
  EXPECT_NEAR(length_of(collector_.take(submap_until(30, 0))), 60.0, 1e-3);
}

TEST_F(CollectorTest, IgnoresPositionsThatAreNowhere) {
  drive(0, 30, [](int scan, flow::TrackedObjects& objects) {
    if (scan == 10) objects.objects[0].position_in_odom_m.x() = 1e11;
    if (scan == 20) objects.objects[0].position_in_odom_m.x() = 1e5;
  });
  const auto streams = collector_.take(submap_until(30, 0));
  EXPECT_LE(length_of(streams), 30.0);
  EXPECT_GE(length_of(streams), 25.0);
}

/// A vehicle that stands for a day at a junction.
TEST_F(CollectorTest, HasBoundedMemoryHoweverLongASubmapLasts) {
  std::uint32_t cars = 0;
  for (int lap = 0; lap < 2000; ++lap) {
    for (int scan = 0; scan < 20; ++scan) {
      flow::TrackedObjects objects = car_at_scan(scan, cars);
      objects.stamp_ns += lap * 3'000'000'000LL;
      objects.objects[0].position_in_odom_m.y() = 2.0 * (lap % 300);
      collector_.add(objects);
    }
    ++cars;
  }
  flow::Submap submap = submap_until(20, 0);
  submap.last_stamp_ns = 1'000'000'000'000'000;
  const auto streams = collector_.take(submap);
  EXPECT_LE(streams.size(), 300U * 45U) << "cells that were crossed, not crossings";
  EXPECT_NEAR(length_of(streams), 2000.0 * 19.0, 10.0);
}

TEST_F(CollectorTest, FollowsOneTrackForAnyTime) {
  drive(0, 3000);
  EXPECT_NEAR(length_of(collector_.take(submap_until(3000, 0))), 3000.0, 0.5);
}

TEST_F(CollectorTest, TakesNoMoreTracksThanItHasRoomFor) {
  flow::TrackedObjects objects = car_at_scan(0);
  const flow::TrackedObject car = objects.objects[0];
  for (std::uint32_t id = 0; id < 3 * TrafficCollector::kMostTracks; ++id) {
    objects.objects.push_back(car);
    objects.objects.back().track_id = {100 + id};
    objects.objects.back().position_in_odom_m.y() = 0.5 * id;
  }
  for (int scan = 0; scan <= 10; ++scan) {
    objects.stamp_ns += 100'000'000;
    for (flow::TrackedObject& object : objects.objects) object.position_in_odom_m.x() += 1.0;
    collector_.add(objects);
  }
  const auto streams = collector_.take(submap_until(100, 0));
  EXPECT_NEAR(length_of(streams), 10.0 * TrafficCollector::kMostTracks, 1.0);
}

}  // namespace
}  // namespace slammot::traffic
