#include "common/files/street_file.hpp"

#include <gtest/gtest.h>

#include "common/files/georeference_findings.hpp"
#include "common/files/street_findings.hpp"

namespace slammot::files {
namespace {

constexpr const char* kOsm = R"(<?xml version="1.0"?>
<osm version="0.6">
 <node id="1" lat="40.4400" lon="-79.9960"/>
 <node id="2" lat="40.4410" lon="-79.9960"/>
 <node id="3" lat="40.4410" lon="-79.9940"/>
 <way id="7"><nd ref="1"/><nd ref="2"/><nd ref="99"/><tag k="highway" v="residential"/><tag k="name" v="Main"/></way>
 <way id="8"><nd ref="2"/><nd ref="3"/><tag k="highway" v="footway"/></way>
 <way id="9"><nd ref="1"/><nd ref="3"/><tag k="building" v="yes"/></way>
</osm>)";

TEST(StreetFile, TakesTheWaysOfOpenStreetMapThatCarsUse) {
  const auto graph = parse_streets(kOsm, "map.osm");
  ASSERT_TRUE(graph) << graph.error().message;
  ASSERT_EQ(graph->streets.size(), 1U);
  EXPECT_EQ(graph->streets[0].name, "Main");
  ASSERT_EQ(graph->streets[0].line_m.size(), 2U);
  EXPECT_NEAR(graph->streets[0].line_m[1].y(), 111.0, 0.5);
  EXPECT_NEAR(graph->length_m(), 111.0, 0.5);
}

TEST(StreetFile, ReadsTheGeoJsonThatItWrites) {
  const streets::StreetGraph graph{
      {40.44, -79.99}, {{"a", {{0.0, 0.0}, {50.0, 10.0}}}, {"b", {{50.0, 10.0}, {50.0, 90.0}}}}};
  const auto read = parse_streets(to_geojson(graph), "streets.geojson");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->streets.size(), 2U);
  EXPECT_EQ(read->streets[1].name, "b");
  EXPECT_NEAR(read->streets[1].line_m[1].x(), 50.0, 1e-3);
  EXPECT_NEAR(read->streets[1].line_m[1].y(), 90.0, 1e-3);
}

TEST(StreetFile, TakesLinesOfSeveralPartsAndSkipsOtherShapes) {
  const auto graph = parse_streets(R"({"type": "FeatureCollection", "features": [
    {"geometry": {"type": "MultiLineString", "coordinates": [[[8.0, 50.0], [8.001, 50.0]], [[8.0, 50.0], [8.0, 50.001]]]}},
    {"properties": {"highway": "cycleway"}, "geometry": {"type": "LineString", "coordinates": [[8.0, 50.0], [8.001, 50.0]]}},
    {"geometry": {"type": "Point", "coordinates": [8.0, 50.0]}}, 7, {"geometry": null}]})",
                                   "x");
  ASSERT_TRUE(graph) << graph.error().message;
  EXPECT_EQ(graph->streets.size(), 2U);
}

TEST(StreetFile, SaysInOneLineWhyAFileIsNoStreetGraph) {
  EXPECT_EQ(parse_streets("hello", "x").error().message,
            "x: neither OpenStreetMap XML nor GeoJSON");
  EXPECT_EQ(parse_streets("{\"features\": []}", "x").error().message,
            "x: no street that cars may use");
  EXPECT_EQ(parse_streets("<osm><node", "x").error().message.substr(0, 4), "x:1:");
  EXPECT_EQ(parse_streets("<osm/>", "x").error().message, "x: no street that cars may use");
  EXPECT_EQ(parse_streets("", "x").error().message, "x: neither OpenStreetMap XML nor GeoJSON");
  EXPECT_FALSE(read_streets("/nonexistent/streets.geojson"));
}

TEST(DescribeGeoreference, NamesOutliersAndBias) {
  flow::Georeference found;
  found.has_position = found.has_direction = true;
  found.fixes = 800;
  found.rejected_fixes = 72;
  found.fix_sigma_m = 1.9;
  found.headings = 400;
  found.rejected_headings = 40;
  found.compass_bias_rad = 0.0541;
  EXPECT_EQ(describe_georeference(found),
            "GNSS: 800 fixes, 9 % rejected as multipath, error 1.9 m, agrees with the map; "
            "compass: 400 readings, bias 3.1 degrees, 10 % rejected as disturbed, believed");
}

TEST(DescribeGeoreference, SaysThatAbsurdFixesAndATurnedCompassAreNotUsed) {
  flow::Georeference found;
  found.fixes = 299;
  found.fix_sigma_m = 1007.5;
  EXPECT_EQ(describe_georeference(found),
            "GNSS: 299 fixes, error 1007.5 m, contradicts the map: not used");
  found.has_position = found.has_direction = true;
  found.fix_sigma_m = 7.3;
  found.headings = 834;
  found.compass_bias_rad = -1.6;
  EXPECT_EQ(
      describe_georeference(found),
      "GNSS: 299 fixes, 0 % rejected as multipath, error 7.3 m, agrees with the map; compass: "
      "834 readings, bias -91.7 degrees against GNSS: mounted at 90 degrees? not used");
}

TEST(DescribeStreets, CallsASinglySureSearchAmbiguous) {
  streets::StreetSearch search;
  search.location = {streets::StreetVerdict::kLocated, 200.0, {{{}, 3.0, 0.9, 0.97}}};
  EXPECT_EQ(describe_streets(findings_of(search, {40.0, -80.0})),
            "ambiguous after 200 m: 1 places fit, the best with probability 0.97");
  search.located_after_m = 250.0;
  search.location.way_m = 250.0;
  EXPECT_EQ(describe_streets(findings_of(search, {40.0, -80.0})),
            "located after 250 m, 90 % of the way on streets");
}

}  // namespace
}  // namespace slammot::files
