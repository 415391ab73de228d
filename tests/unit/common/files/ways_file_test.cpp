#include "common/files/ways_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slammot::files {
namespace {

using ::testing::HasSubstr;
using traffic::Mover;
using traffic::Way;

std::vector<Way> example_ways() {
  Way lane{Mover::kVehicle, 3, {{0.0, 0.0}, {10.0, 0.5}}, 8.25, 1.5, 3.0, 4.0, 0.8};
  Way walkway{
      Mover::kPedestrian, 4, {{0.0, 5.0}, {10.0, 5.0}, {12.0, 7.0}}, 1.25, 0.25, 1.5, 1.0, 0.5};
  return {lane, walkway};
}

TEST(WaysFile, ReadsWhatItWrites) {
  const auto read = parse_ways(to_geojson(example_ways()), "lanes");
  ASSERT_TRUE(read);
  ASSERT_EQ(read->size(), 2U);
  const Way& lane = read->front();
  EXPECT_EQ(lane.mover, Mover::kVehicle);
  EXPECT_EQ(lane.line, 3);
  EXPECT_EQ(lane.points_in_map_m, example_ways().front().points_in_map_m);
  EXPECT_EQ(lane.speed_mps, 8.25);
  EXPECT_EQ(lane.speed_spread_mps, 1.5);
  EXPECT_EQ(lane.width_m, 3.0);
  EXPECT_EQ(lane.tracks, 4.0);
  EXPECT_EQ(lane.confidence, 0.8);
  EXPECT_EQ(read->back().mover, Mover::kPedestrian);
  EXPECT_EQ(read->back().points_in_map_m.size(), 3U);
}

TEST(WaysFile, SaysThatItCountsMetresOfTheMap) {
  EXPECT_THAT(to_geojson({}), HasSubstr(R"("frame":"map","unit":"m")"));
  EXPECT_TRUE(parse_ways(to_geojson({}), "lanes")->empty());
}

TEST(WaysFile, RefusesWhatIsDamagedWithOneLine) {
  const std::string whole = to_geojson(example_ways());
  const auto without = [&](const std::string& word) {
    std::string text = whole;
    return text.replace(text.find(word), word.size(), "\"x\"");
  };
  for (const std::string& text :
       {std::string(), std::string("[]"), whole.substr(0, whole.size() / 2), without("\"lane\""),
        without("\"speed\""), without("\"coordinates\""), without("\"confidence\"")}) {
    const auto read = parse_ways(text, "lanes.geojson");
    ASSERT_FALSE(read) << text;
    EXPECT_THAT(read.error().message, HasSubstr("lanes.geojson"));
    EXPECT_EQ(read.error().message.find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace slammot::files
