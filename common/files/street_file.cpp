#include "common/files/street_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <unordered_map>
#include <utility>

#include <expat.h>
#include <nlohmann/json.hpp>

#include "common/files/finite_number.hpp"

namespace slammot::files {
namespace {

using geometry::Geodetic;
using Json = nlohmann::ordered_json;

/// A line on the earth.
struct GeodeticLine {
  std::string name;
  std::vector<Geodetic> points;
};

bool is_on_earth(const Geodetic& place) {
  return std::abs(place.latitude_deg) < 89.0 && std::abs(place.longitude_deg) <= 180.0;
}

/// Values of the tag highway whose ways cars do not use.
bool is_drivable(std::string_view highway) {
  constexpr std::array<std::string_view, 13> kOthers{
      "footway",  "path",     "cycleway",     "steps",    "pedestrian", "bridleway", "corridor",
      "elevator", "platform", "construction", "proposed", "raceway",    "track"};
  return std::ranges::find(kOthers, highway) == kOthers.end();
}

Result<streets::StreetGraph> graph_of(const std::vector<GeodeticLine>& lines,
                                      const std::string& name) {
  constexpr double kMost_m = 100e3;  // from the origin: farther the projection is off
  streets::StreetGraph graph;
  for (const GeodeticLine& line : lines) {
    if (line.points.size() < 2) continue;
    if (graph.streets.empty()) graph.origin = line.points.front();
    streets::Street street{line.name, {}};
    for (const Geodetic& point : line.points)
      street.line_m.push_back(geometry::east_north_m(graph.origin, point));
    if (std::ranges::all_of(street.line_m, [](const auto& p) { return p.norm() < kMost_m; }))
      graph.streets.push_back(std::move(street));
  }
  if (graph.streets.empty()) return Error{name + ": no street that cars may use"};
  return graph;
}

/// Elements of an OpenStreetMap file: nodes come before the ways that refer to them.
class OsmReader {
 public:
  explicit OsmReader(XML_Parser parser) {
    XML_SetUserData(parser, this);
    XML_SetElementHandler(parser, begin_element, end_element);
  }

  std::vector<GeodeticLine> lines() { return std::move(lines_); }

 private:
  static void begin_element(void* user, const XML_Char* element, const XML_Char** attributes) {
    static_cast<OsmReader*>(user)->begin(element, attributes);
  }
  static void end_element(void* user, const XML_Char* element) {
    static_cast<OsmReader*>(user)->end(element);
  }

  static std::string_view value(const XML_Char** attributes, std::string_view name) {
    for (const XML_Char** at = attributes; *at != nullptr; at += 2) {
      if (name == at[0]) return at[1];
    }
    return {};
  }

  void begin(std::string_view element, const XML_Char** attributes) {
    if (element == "node") add_node(attributes);
    if (element == "way") way_ = Way{};
    if (!way_) return;
    if (element == "nd") {
      const auto node = nodes_.find(std::string(value(attributes, "ref")));
      if (node != nodes_.end()) way_->line.points.push_back(node->second);
    }
    if (element == "tag") {
      const std::string_view key = value(attributes, "k");
      if (key == "highway") way_->highway = value(attributes, "v");
      if (key == "name") way_->line.name = value(attributes, "v");
    }
  }

  void end(std::string_view element) {
    if (element != "way" || !way_) return;
    if (!way_->highway.empty() && is_drivable(way_->highway))
      lines_.push_back(std::move(way_->line));
    way_.reset();
  }

  void add_node(const XML_Char** attributes) {
    const auto latitude_deg = finite_number(value(attributes, "lat"));
    const auto longitude_deg = finite_number(value(attributes, "lon"));
    if (!latitude_deg || !longitude_deg || !is_on_earth({*latitude_deg, *longitude_deg})) return;
    nodes_[std::string(value(attributes, "id"))] = {*latitude_deg, *longitude_deg};
  }

  struct Way {
    GeodeticLine line;
    std::string highway;
  };

  std::unordered_map<std::string, Geodetic> nodes_;
  std::optional<Way> way_;
  std::vector<GeodeticLine> lines_;
};

Result<streets::StreetGraph> parse_osm(std::string_view text, const std::string& name) {
  const std::unique_ptr<XML_ParserStruct, void (*)(XML_Parser)> parser(XML_ParserCreate(nullptr),
                                                                       XML_ParserFree);
  OsmReader reader(parser.get());
  if (text.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    return Error{name + ": larger than 2 GB: extract the area of the drive"};
  if (XML_Parse(parser.get(), text.data(), static_cast<int>(text.size()), XML_TRUE) !=
      XML_STATUS_OK)
    return Error{name + ":" + std::to_string(XML_GetCurrentLineNumber(parser.get())) + ": " +
                 XML_ErrorString(XML_GetErrorCode(parser.get()))};
  return graph_of(reader.lines(), name);
}

std::optional<Geodetic> place_of(const Json& coordinates) {
  if (!coordinates.is_array() || coordinates.size() < 2 || !coordinates[0].is_number() ||
      !coordinates[1].is_number())
    return std::nullopt;
  const Geodetic place{coordinates[1].get<double>(), coordinates[0].get<double>()};
  return is_on_earth(place) ? std::optional(place) : std::nullopt;
}

void add_line(const Json& coordinates, const std::string& name, std::vector<GeodeticLine>& lines) {
  if (!coordinates.is_array()) return;
  GeodeticLine line{name, {}};
  for (const Json& one : coordinates) {
    if (const auto place = place_of(one)) line.points.push_back(*place);
  }
  lines.push_back(std::move(line));
}

std::string word(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

void add_feature(const Json& feature, std::vector<GeodeticLine>& lines) {
  if (!feature.is_object()) return;
  const Json properties = feature.value("properties", Json::object());
  const Json shape = feature.value("geometry", Json::object());
  if (!properties.is_object() || !shape.is_object()) return;
  const std::string highway = word(properties, "highway");
  if (!highway.empty() && !is_drivable(highway)) return;
  const std::string name = word(properties, "name");
  const Json coordinates = shape.value("coordinates", Json::array());
  if (word(shape, "type") == "LineString") add_line(coordinates, name, lines);
  if (word(shape, "type") == "MultiLineString" && coordinates.is_array())
    for (const Json& one : coordinates) add_line(one, name, lines);
}

Result<streets::StreetGraph> parse_geojson(std::string_view text, const std::string& name) {
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) return Error{name + ": neither OpenStreetMap XML nor GeoJSON"};
  std::vector<GeodeticLine> lines;
  if (json.is_object() && json.contains("features") && json["features"].is_array()) {
    for (const Json& feature : json["features"]) add_feature(feature, lines);
  }
  return graph_of(lines, name);
}

}  // namespace

Result<streets::StreetGraph> parse_streets(std::string_view text, const std::string& name) {
  const std::size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  const bool is_xml = first != std::string_view::npos && text[first] == '<';
  return is_xml ? parse_osm(text, name) : parse_geojson(text, name);
}

Result<streets::StreetGraph> read_streets(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return Error{file.string() + ": cannot be read"};
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  return parse_streets(text, file.string());
}

std::string to_geojson(const streets::StreetGraph& graph) {
  constexpr double kDecimals = 1e9;
  Json features = Json::array();
  for (const streets::Street& street : graph.streets) {
    Json coordinates = Json::array();
    for (const geometry::Vector2& point_m : street.line_m) {
      const Geodetic place = geometry::geodetic_at(graph.origin, point_m);
      coordinates.push_back({std::round(place.longitude_deg * kDecimals) / kDecimals,
                             std::round(place.latitude_deg * kDecimals) / kDecimals});
    }
    features.push_back(
        {{"type", "Feature"},
         {"properties", {{"name", street.name}, {"highway", "residential"}}},
         {"geometry", {{"type", "LineString"}, {"coordinates", std::move(coordinates)}}}});
  }
  return Json{{"type", "FeatureCollection"}, {"features", std::move(features)}}.dump(1) + "\n";
}

}  // namespace slammot::files
