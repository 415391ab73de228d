#include "services/gateway/way_messages.hpp"

#include <cmath>

#include "services/gateway/json_parts.hpp"
#include "services/gateway/message_parts.hpp"

namespace slammot::gateway {
namespace {

using geometry::Vector2;

constexpr double kWayHeightM = 0.02;

const char* kind_of(traffic::Mover mover) {
  switch (mover) {
    case traffic::Mover::kVehicle: return "lane";
    case traffic::Mover::kBicycle: return "cycle_lane";
    case traffic::Mover::kPedestrian: return "walkway";
  }
  return "";
}

/// As the movers themselves are drawn.
Rgba ink_of(traffic::Mover mover, double alpha) {
  switch (mover) {
    case traffic::Mover::kVehicle: return {0.90, 0.48, 0.0, alpha};
    case traffic::Mover::kBicycle: return {0.0, 0.62, 0.45, alpha};
    case traffic::Mover::kPedestrian: return {0.80, 0.47, 0.65, alpha};
  }
  return {0.6, 0.6, 0.6, alpha};
}

foxglove::LinePrimitive& add_strip(const traffic::Way& way, double alpha,
                                   foxglove::SceneEntity& entity) {
  foxglove::LinePrimitive& line = *entity.add_lines();
  line.set_type(foxglove::LinePrimitive::LINE_STRIP);
  set_pose({}, kWayHeightM, *line.mutable_pose());
  set_color(ink_of(way.mover, alpha), *line.mutable_color());
  for (const Vector2& point_m : way.points_in_map_m) {
    foxglove::Point3& point = *line.add_points();
    point.set_x(point_m.x());
    point.set_y(point_m.y());
  }
  return line;
}

void add_direction(const traffic::Way& way, double alpha, foxglove::SceneEntity& entity) {
  constexpr double kHeadM = 0.9;
  const std::size_t middle = way.points_in_map_m.size() / 2;
  const Vector2 tail_m = way.points_in_map_m[middle - 1];
  const Vector2 along_m = way.points_in_map_m[middle] - tail_m;
  foxglove::ArrowPrimitive& arrow = *entity.add_arrows();
  set_pose({tail_m.x(), tail_m.y(), std::atan2(along_m.y(), along_m.x())}, kWayHeightM,
           *arrow.mutable_pose());
  arrow.set_shaft_length(0.0);
  arrow.set_head_length(kHeadM);
  arrow.set_head_diameter(kHeadM);
  set_color(ink_of(way.mover, alpha), *arrow.mutable_color());
}

void add_way(const traffic::Way& way, foxglove::SceneEntity& entity) {
  constexpr double kLineWidthPx = 1.5;
  add_strip(way, 0.2 * way.confidence, entity).set_thickness(way.width_m);
  const double alpha = 0.2 + 0.6 * way.confidence;
  foxglove::LinePrimitive& middle = add_strip(way, alpha, entity);
  middle.set_thickness(kLineWidthPx);
  middle.set_scale_invariant(true);
  if (traffic::is_directed(way.mover)) add_direction(way, alpha, entity);
}

/// Of lengths in m and of what has no more certain digits.
double in_hundredths(double value) { return std::round(value * 1e2) / 1e2; }

Json way_json(const traffic::Way& way) {
  Json points = Json::array();
  for (const Vector2& point_m : way.points_in_map_m) {
    points.push_back(in_hundredths(point_m.x()));
    points.push_back(in_hundredths(point_m.y()));
  }
  return {{"kind", kind_of(way.mover)},
          {"line", way.line},
          {"directed", traffic::is_directed(way.mover)},
          {"speed", in_hundredths(way.speed_mps)},
          {"speed_spread", in_hundredths(way.speed_spread_mps)},
          {"width", in_hundredths(way.width_m)},
          {"tracks", in_hundredths(way.tracks)},
          {"confidence", in_hundredths(way.confidence)},
          {"points", std::move(points)}};
}

}  // namespace

foxglove::SceneUpdate ways_scene(const traffic::TrafficWays& ways) {
  foxglove::SceneUpdate message;
  foxglove::SceneEntity& entity = *message.add_entities();
  set_time(ways.stamp_ns, *entity.mutable_timestamp());
  entity.set_frame_id(kMapFrame);
  entity.set_id("ways");
  for (const traffic::Way& way : ways.ways) add_way(way, entity);
  return message;
}

std::string ways_json(const traffic::TrafficWays& ways) {
  Json json = {{"map", std::to_string(ways.map_id.value)},
               {"stamp_ns", std::to_string(ways.stamp_ns)},
               {"ways", Json::array()}};
  for (const traffic::Way& way : ways.ways) json["ways"].push_back(way_json(way));
  return json.dump();
}

}  // namespace slammot::gateway
