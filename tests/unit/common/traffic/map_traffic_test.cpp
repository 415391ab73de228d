#include "common/traffic/map_traffic.hpp"

#include <gtest/gtest.h>

#include "common/traffic/ways.hpp"
#include "tests/unit/common/traffic/passages.hpp"

namespace slammot::traffic {
namespace {

/// Of three cars that went 40 m along x, in the frame of the submap.
std::vector<FreeStream> lane_of_submap() {
  TrafficMap map;
  for (const double y_m : {-0.1, 0.0, 0.1}) map.add(straight({0.0, y_m}, {40.0, y_m}));
  return map.free_streams({});
}

flow::GraphCorrection correction(std::vector<flow::CorrectedSubmap> submaps) {
  flow::GraphCorrection made;
  made.submaps = std::move(submaps);
  return made;
}

std::vector<Way> ways_of(const MapTraffic& traffic) {
  return find_ways(traffic_in_map(traffic.placed()));
}

TEST(MapTraffic, HasTheSameWaysAsAMapOfWholeTracks) {
  TrafficMap whole;
  for (const double y_m : {-0.1, 0.0, 0.1}) whole.add(straight({0.0, y_m}, {40.0, y_m}));
  MapTraffic traffic;
  traffic.add({0}, lane_of_submap());
  traffic.place(correction({{{0}, {}}}));
  const auto expected = find_ways(whole);
  const auto found = ways_of(traffic);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_EQ(found[i].points_in_map_m.size(), expected[i].points_in_map_m.size());
    EXPECT_NEAR((found[i].points_in_map_m[0] - expected[i].points_in_map_m[0]).norm(), 0.0, 0.01);
    EXPECT_NEAR(found[i].speed_mps, expected[i].speed_mps, 1e-3);
    EXPECT_NEAR(found[i].tracks, expected[i].tracks, 0.05);
    EXPECT_NEAR(found[i].confidence, expected[i].confidence, 0.005);
  }
}

TEST(MapTraffic, MovesItsLanesWithTheSubmapWhenALoopIsClosed) {
  MapTraffic traffic;
  traffic.add({0}, lane_of_submap());
  traffic.place(correction({{{0}, {}}}));
  ASSERT_FALSE(ways_of(traffic).empty());
  const geometry::Pose2 corrected{3.0, 50.0, M_PI / 2.0};
  traffic.place(correction({{{0}, corrected}}));
  const auto ways = ways_of(traffic);
  ASSERT_FALSE(ways.empty());
  for (const Way& way : ways) {
    for (const Vector2& point_m : way.points_in_map_m) {
      EXPECT_NEAR(point_m.x(), 3.0, 0.3);
      EXPECT_GE(point_m.y(), 48.0);
    }
    EXPECT_GT(way.points_in_map_m.back().y(), way.points_in_map_m.front().y());
  }
}

TEST(MapTraffic, JoinsTheLanesOfSubmaps) {
  MapTraffic traffic;
  traffic.add({0}, lane_of_submap());
  traffic.add({1}, lane_of_submap());
  traffic.place(correction({{{0}, {}}, {{1}, {0.0, 0.2, 0.0}}}));
  double most_tracks = 0.0;
  for (const Way& way : ways_of(traffic)) most_tracks = std::max(most_tracks, way.tracks);
  EXPECT_GT(most_tracks, 5.0) << "three cars in each";
}

TEST(MapTraffic, LeavesOutSubmapsWithoutAPlace) {
  MapTraffic traffic;
  traffic.add({0}, lane_of_submap());
  EXPECT_TRUE(traffic.placed().empty());
  EXPECT_FALSE(traffic.take_change());
}

TEST(MapTraffic, DoesNotPlaceNewSubmapsWhileTheyAreUntied) {
  MapTraffic traffic;
  traffic.add({0}, lane_of_submap());
  traffic.add({1}, lane_of_submap());
  traffic.place(correction({{{0}, {}}}));
  flow::GraphCorrection untied = correction({{{0}, {1.0, 0.0, 0.0}}, {{1}, {}}});
  untied.is_untied = true;
  traffic.place(untied);
  ASSERT_EQ(traffic.placed().size(), 1U);
  EXPECT_EQ(traffic.placed()[0].map_from_submap.x_m, 1.0);
  untied.is_untied = false;
  traffic.place(untied);
  EXPECT_EQ(traffic.placed().size(), 2U);
}

TEST(MapTraffic, TellsAChangeOnceAndNoneForMillimetres) {
  MapTraffic traffic;
  traffic.add({0}, lane_of_submap());
  traffic.place(correction({{{0}, {}}}));
  EXPECT_TRUE(traffic.take_change());
  EXPECT_FALSE(traffic.take_change());
  traffic.place(correction({{{0}, {0.03, 0.0, 0.0}}}));
  EXPECT_FALSE(traffic.take_change());
  traffic.place(correction({{{0}, {0.06, 0.0, 0.0}}}));
  EXPECT_TRUE(traffic.take_change()) << "small moves add up";
  traffic.add({0}, lane_of_submap());
  EXPECT_TRUE(traffic.take_change());
}

TEST(MapTraffic, HasBoundedMemory) {
  const std::size_t streams = lane_of_submap().size();
  MapTraffic traffic(5 * streams);
  std::vector<flow::CorrectedSubmap> places;
  for (std::uint32_t id = 0; id < 50; ++id) {
    traffic.add({id}, lane_of_submap());
    places.push_back({{id}, {100.0 * id, 0.0, 0.0}});
  }
  traffic.place(correction(places));
  EXPECT_EQ(traffic.size(), 5 * streams);
  EXPECT_EQ(traffic.left_out(), 45U);
  ASSERT_EQ(traffic.placed().size(), 5U);
  EXPECT_EQ(traffic.placed()[0].map_from_submap.x_m, 4500.0) << "the latest submaps stay";
}

}  // namespace
}  // namespace slammot::traffic
