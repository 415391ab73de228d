#include "services/gateway/way_messages.hpp"

#include <map>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/wire/traffic_ways.hpp"
#include "services/gateway/map_publisher.hpp"
#include "tests/support/values.hpp"

namespace slammot::gateway {
namespace {

using slammot::testing::way;
using traffic::Mover;

traffic::TrafficWays lane_and_walkway(std::uint64_t map = 7) {
  return {1, 2'000'000'000, {map}, {way(Mover::kVehicle, 5), way(Mover::kPedestrian, 3)}};
}

TEST(WaysScene, DrawsEachWayAsWideAsItIsUsedAndArrowsWhereItHasADirection) {
  const foxglove::SceneUpdate scene = ways_scene(lane_and_walkway());
  ASSERT_EQ(scene.entities_size(), 1);
  const foxglove::SceneEntity& entity = scene.entities(0);
  EXPECT_EQ(entity.frame_id(), "map");
  ASSERT_EQ(entity.lines_size(), 4);
  EXPECT_EQ(entity.lines(0).thickness(), 2.75);
  EXPECT_FALSE(entity.lines(0).scale_invariant());
  EXPECT_TRUE(entity.lines(1).scale_invariant());
  EXPECT_EQ(entity.lines(1).points_size(), 5);
  EXPECT_EQ(entity.lines(1).points(4).x(), 4.125);
  EXPECT_EQ(entity.arrows_size(), 1) << "a walkway is used in both directions";
}

TEST(WaysJson, HasAllPropertiesOfAWay) {
  const auto json = nlohmann::json::parse(ways_json(lane_and_walkway()));
  EXPECT_EQ(json["map"], "7");
  ASSERT_EQ(json["ways"].size(), 2U);
  const auto& lane = json["ways"][0];
  EXPECT_EQ(lane["kind"], "lane");
  EXPECT_EQ(lane["directed"], true);
  EXPECT_EQ(lane["line"], 6);
  EXPECT_EQ(lane["speed"], 5.25);
  EXPECT_EQ(lane["width"], 2.75);
  EXPECT_EQ(lane["tracks"], 5.5);
  EXPECT_EQ(lane["points"].size(), 10U);
  EXPECT_EQ(json["ways"][1]["kind"], "walkway");
  EXPECT_EQ(json["ways"][1]["directed"], false);
}

/// Keeps the last message of each channel.
struct LastMessages : Audience {
  bool is_wanted(ChannelId) const override { return false; }
  void publish(ChannelId channel, std::int64_t, std::string payload) override {
    last[channel] = std::move(payload);
  }
  void put(const std::string&, Content) override {}
  void remove(const std::string&) override {}

  std::size_t ways() const {
    return nlohmann::json::parse(last.at(ChannelId::kWayDetails))["ways"].size();
  }

  std::map<ChannelId, std::string> last;
};

struct PublishedWays : ::testing::Test {
  void take(const traffic::TrafficWays& ways) {
    wire::TrafficWaysEncoder().encode("car", ways, [this](const slammot_TrafficWays& part) {
      EXPECT_EQ(publisher.take(part), "");
    });
    publisher.publish({});
  }
  void drive_in(std::uint64_t map) {
    flow::LocalizedScan scan;
    scan.stamp_ns = 1;
    scan.map_id = {map};
    publisher.follow(scan);
    publisher.publish({});
  }

  LastMessages audience;
  MapPublisher publisher{audience};
};

TEST_F(PublishedWays, AreThoseOfTheMapInUse) {
  take(lane_and_walkway(7));
  EXPECT_TRUE(audience.last.empty()) << "no map is in use";
  drive_in(7);
  EXPECT_EQ(audience.ways(), 2U);
  EXPECT_TRUE(audience.last.contains(ChannelId::kWays));
  take(lane_and_walkway(8));
  traffic::TrafficWays more = lane_and_walkway(7);
  more.sequence = 5;
  more.ways.push_back(way(Mover::kBicycle, 4));
  take(more);
  EXPECT_EQ(audience.ways(), 3U);
}

TEST_F(PublishedWays, EndWithTheMap) {
  take(lane_and_walkway(7));
  drive_in(7);
  drive_in(8);
  EXPECT_EQ(audience.ways(), 0U) << "viewers drop those of the map before";
}

TEST_F(PublishedWays, AreRefusedWhereTheyAreUnsound) {
  slammot_TrafficWays unsound{};
  EXPECT_NE(publisher.take(unsound), "") << "it has no part";
}

}  // namespace
}  // namespace slammot::gateway
