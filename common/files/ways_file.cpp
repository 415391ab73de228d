#include "common/files/ways_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

namespace slammot::files {
namespace {

using WayJson = nlohmann::ordered_json;

constexpr std::array<const char*, traffic::kMovers> kKinds = {"lane", "cycle_lane", "walkway"};

double in_thousandths(double value) { return std::round(value * 1e3) / 1e3; }

WayJson json_of(const traffic::Way& way) {
  WayJson coordinates = WayJson::array();
  for (const geometry::Vector2& point_m : way.points_in_map_m)
    coordinates.push_back({in_thousandths(point_m.x()), in_thousandths(point_m.y())});
  return {{"type", "Feature"},
          {"properties",
           {{"kind", kKinds[static_cast<std::size_t>(way.mover)]},
            {"line", way.line},
            {"speed", in_thousandths(way.speed_mps)},
            {"speed_spread", in_thousandths(way.speed_spread_mps)},
            {"width", in_thousandths(way.width_m)},
            {"tracks", in_thousandths(way.tracks)},
            {"confidence", in_thousandths(way.confidence)}}},
          {"geometry", {{"type", "LineString"}, {"coordinates", std::move(coordinates)}}}};
}

std::optional<double> number(const WayJson& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end() || !found->is_number()) return std::nullopt;
  const auto value = found->get<double>();
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::vector<geometry::Vector2> points_of(const WayJson& coordinates) {
  std::vector<geometry::Vector2> points_m;
  for (const WayJson& point : coordinates) {
    if (!point.is_array() || point.size() < 2 || !point[0].is_number() || !point[1].is_number())
      return {};
    points_m.emplace_back(point[0].get<double>(), point[1].get<double>());
  }
  return points_m;
}

/// None if a member is missing or of the wrong type.
std::optional<traffic::Way> way_of(const WayJson& feature) {
  if (!feature.is_object() || !feature.contains("properties") || !feature.contains("geometry"))
    return std::nullopt;
  const WayJson& properties = feature["properties"];
  const WayJson& line = feature["geometry"];
  if (!properties.is_object() || !line.is_object() || !line.contains("coordinates"))
    return std::nullopt;
  const auto kind = std::ranges::find(kKinds, properties.value("kind", std::string()));
  traffic::Way way;
  way.points_in_map_m = points_of(line["coordinates"]);
  if (kind == kKinds.end() || way.points_in_map_m.size() < 2) return std::nullopt;
  way.mover = static_cast<traffic::Mover>(kind - kKinds.begin());
  const auto line_number = number(properties, "line");
  if (!line_number || std::abs(*line_number) > 1e9) return std::nullopt;
  way.line = static_cast<int>(*line_number);
  for (const auto& [name, member] : {std::pair("speed", &traffic::Way::speed_mps),
                                     {"speed_spread", &traffic::Way::speed_spread_mps},
                                     {"width", &traffic::Way::width_m},
                                     {"tracks", &traffic::Way::tracks},
                                     {"confidence", &traffic::Way::confidence}}) {
    const auto value = number(properties, name);
    if (!value) return std::nullopt;
    way.*member = *value;
  }
  return way;
}

}  // namespace

std::string to_geojson(const std::vector<traffic::Way>& ways) {
  std::string text = R"({"type":"FeatureCollection","frame":"map","unit":"m","features":[)";
  const char* separator = "\n";
  for (const traffic::Way& way : ways) {
    text.append(separator).append(json_of(way).dump());
    separator = ",\n";
  }
  return text + "\n]}\n";
}

Result<std::vector<traffic::Way>> parse_ways(std::string_view text, const std::string& name) {
  const WayJson json = WayJson::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("features") || !json["features"].is_array())
    return Error{name + ": not a GeoJSON collection of features"};
  std::vector<traffic::Way> ways;
  for (const WayJson& feature : json["features"]) {
    auto way = way_of(feature);
    if (!way)
      return Error{name + ": feature " + std::to_string(ways.size()) +
                   " is not a lane, cycle_lane or walkway with all its properties"};
    ways.push_back(std::move(*way));
  }
  return ways;
}

Result<std::vector<traffic::Way>> read_ways(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return Error{file.string() + ": cannot be read"};
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  return parse_ways(text, file.string());
}

}  // namespace slammot::files
