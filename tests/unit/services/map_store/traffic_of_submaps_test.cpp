#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/wire/graph.hpp"
#include "common/wire/tracked_objects.hpp"
#include "common/wire/traffic_ways.hpp"
#include "services/map_store/map_store_service.hpp"
#include "tests/support/example_streams.hpp"
#include "tests/support/example_submap.hpp"
#include "tests/support/service_on_the_bus.hpp"

namespace slammot::map_store {
namespace {

using slammot::testing::example_streams;
using slammot::testing::example_submap;
using slammot::testing::kForever;

/// A car at 10 m/s along x of odom, in a map whose first submap has its origin at odom's.
struct TrafficOnTheBus : slammot::testing::ServiceOnTheBus {
  dds::Writer<slammot_SubmapTile> tiles{neighbour_, dds::topics::kSubmapTile};
  dds::Writer<slammot_TrackedObjects> objects{neighbour_, dds::topics::kTrackedObjects};
  dds::Writer<slammot_GraphCorrection> corrections{neighbour_, dds::topics::kGraphCorrection};
  std::unique_ptr<dds::Reader<slammot_TrafficWays>> reader =
      std::make_unique<dds::Reader<slammot_TrafficWays>>(neighbour_, dds::topics::kTrafficWays);
  wire::TrafficWaysAssembler assembler;
  std::optional<traffic::TrafficWays> ways;
  std::uint32_t sequence = 0;

  static flow::Submap submap(std::uint32_t id) {
    flow::Submap made = example_submap(id);
    made.odom_from_submap = {};
    return made;
  }

  void drive(int scans, double y_m, std::uint64_t map = 5) {
    ASSERT_TRUE(objects.wait_for_readers(1, kForever));
    flow::TrackedObject car;
    car.track_id = {7};
    car.confirmed = true;
    car.velocity_in_odom_mps = {10.0, 0.0};
    car.covariance = 0.01 * Eigen::Matrix4d::Identity();
    car.width_m = 1.8;
    car.class_probability = {0.0, 0.0, 1.0, 0.0};
    flow::TrackedObjects tracked;
    tracked.map_id = {map};
    tracked.odom_id = {3};
    for (int scan = 0; scan < scans; ++scan) {
      tracked.stamp_ns = (scan + 1) * 100'000'000LL;
      car.position_in_odom_m = {1.0 * scan, y_m};
      tracked.objects = {car};
      wire::TrackedObjectsEncoder encoder;
      objects.write(encoder.encode("car", tracked));
      ASSERT_TRUE(comes_to(
          [&] { return objects.wait_for_acknowledgements(std::chrono::milliseconds(1)); }));
    }
  }

  void finish(const flow::Submap& submap) {
    wire::SubmapEncoder().encode("car", submap,
                                 [this](const slammot_SubmapTile& tile) { tiles.write(tile); });
  }

  void correct(std::vector<flow::CorrectedSubmap> submaps) {
    flow::GraphCorrection correction;
    correction.sequence = ++sequence;
    correction.map_id = example_submap(0).map_id;
    correction.submaps = std::move(submaps);
    wire::GraphCorrectionEncoder().encode(
        "car", correction,
        [this](const slammot_GraphCorrection& part) { corrections.write(part); });
  }

  bool has_ways_at(double y_m) {
    reader->take_each([this](const slammot_TrafficWays& part) {
      auto added = assembler.add(part);
      EXPECT_EQ(added.fault, "");
      if (added.ways) ways = std::move(added.ways);
    });
    return ways && std::ranges::any_of(ways->ways, [y_m](const traffic::Way& way) {
             return std::abs(way.points_in_map_m.front().y() - y_m) < 0.3;
           });
  }

  std::uint64_t counter(const std::string& name) { return context_->status().counter(name); }
};

TEST_F(TrafficOnTheBus, PublishesLanesThatFollowTheirSubmap) {
  start<MapStoreService>("map_store");
  drive(30, 2.0);
  finish(submap(0));
  ASSERT_TRUE(comes_to([&] { return counter("traffic_streams") > 0; }));
  correct({{{0}, {}}});
  ASSERT_TRUE(comes_to([&] { return has_ways_at(2.0); }));
  EXPECT_EQ(ways->map_id, example_submap(0).map_id);
  EXPECT_EQ(ways->ways.front().mover, traffic::Mover::kVehicle);
  EXPECT_NEAR(ways->ways.front().speed_mps, 10.0, 0.1);
  EXPECT_GT(ways->ways.front().points_in_map_m.back().x(), 5.0) << "in the direction of travel";
  correct({{{0}, {0.0, 40.0, 0.0}}});
  EXPECT_TRUE(comes_to([&] { return has_ways_at(42.0); })) << "a loop was closed";
}

TEST_F(TrafficOnTheBus, HasTheLanesOfEarlierDrivesAfterARestart) {
  start<MapStoreService>("map_store");
  drive(30, 2.0);
  finish(submap(0));
  ASSERT_TRUE(comes_to([&] { return counter("stored_submaps") > 0; }));
  EXPECT_EQ(counter("unwritten_traffic"), 0U);
  stop();
  start<MapStoreService>("map_store");
  ASSERT_GT(counter("traffic_streams"), 0U);
  correct({{{0}, {0.0, 5.0, 0.0}}});
  EXPECT_TRUE(comes_to([&] { return has_ways_at(7.0); }));
}

TEST_F(TrafficOnTheBus, TellsALateReaderTheLastWays) {
  start<MapStoreService>("map_store");
  drive(30, 2.0);
  finish(submap(0));
  ASSERT_TRUE(comes_to([&] { return counter("traffic_streams") > 0; }));
  correct({{{0}, {}}});
  ASSERT_TRUE(comes_to([&] { return counter("published_ways") > 0; }));
  reader =
      std::make_unique<dds::Reader<slammot_TrafficWays>>(neighbour_, dds::topics::kTrafficWays);
  assembler = {};
  ways.reset();
  EXPECT_TRUE(comes_to([&] { return has_ways_at(2.0); }));
}

TEST_F(TrafficOnTheBus, CountsADamagedRecordAndKeepsTheOthers) {
  {
    auto opened = Store::open(folder_ / "map.sqlite", {});
    auto& store = std::get<Store>(opened);
    store.put("car", submap(0));
    store.put("car", submap(1));
    ASSERT_TRUE(store.add_traffic("car", submap(0).map_id, {0}, example_streams()));
    std::vector<traffic::FreeStream> unsound = example_streams();
    unsound[0].weight = -1.0F;
    ASSERT_TRUE(store.add_traffic("car", submap(0).map_id, {1}, unsound));
  }
  start<MapStoreService>("map_store");
  EXPECT_EQ(counter("unreadable_traffic"), 1U);
  EXPECT_EQ(counter("traffic_submaps"), 1U);
}

TEST_F(TrafficOnTheBus, BeginsAnotherMapWithoutLanes) {
  start<MapStoreService>("map_store");
  drive(30, 2.0);
  finish(submap(0));
  ASSERT_TRUE(comes_to([&] { return counter("traffic_streams") > 0; }));
  drive(1, 2.0, 99);
  EXPECT_TRUE(comes_to([&] { return counter("traffic_streams") == 0; }));
}

TEST_F(TrafficOnTheBus, LeavesOutADriveUntilItIsLocatedInTheStoredMap) {
  {
    auto opened = Store::open(folder_ / "map.sqlite", {});
    std::get<Store>(opened).put("car", submap(0));
    ASSERT_TRUE(std::get<Store>(opened).add_traffic("car", {5}, {0}, example_streams(30.0F)));
  }
  start<MapStoreService>("map_store");
  drive(30, 2.0);
  finish(submap(1));
  ASSERT_TRUE(comes_to([&] { return counter("traffic_submaps") == 2; }));
  flow::GraphCorrection untied;
  untied.sequence = 1;
  untied.map_id = {5};
  untied.is_untied = true;
  untied.submaps = {{{1}, {}}};
  wire::GraphCorrectionEncoder().encode(
      "car", untied, [this](const slammot_GraphCorrection& part) { corrections.write(part); });
  correct({{{0}, {}}});
  ASSERT_TRUE(comes_to([&] { return has_ways_at(30.0); }));
  for (const traffic::Way& way : ways->ways) EXPECT_GT(way.points_in_map_m.front().y(), 20.0);
  correct({{{0}, {}}, {{1}, {0.0, -10.0, 0.0}}});
  EXPECT_TRUE(comes_to([&] { return has_ways_at(-8.0); }));
}

TEST_F(TrafficOnTheBus, ShowsAVehicleThatStandsTheLanesOfTracksThatEnded) {
  start<MapStoreService>("map_store");
  drive(30, 2.0);
  flow::TrackedObjects nothing;
  nothing.stamp_ns = 5'000'000'000;
  nothing.map_id = {5};
  nothing.odom_id = {3};
  nothing.map_from_odom = {0.0, 10.0, 0.0};
  wire::TrackedObjectsEncoder encoder;
  objects.write(encoder.encode("car", nothing));
  EXPECT_TRUE(comes_to([&] { return has_ways_at(12.0); }));
}

}  // namespace
}  // namespace slammot::map_store
