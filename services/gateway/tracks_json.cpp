#include <cmath>

#include "services/gateway/json_parts.hpp"
#include "services/gateway/track_messages.hpp"

namespace slammot::gateway {
namespace {

/// Text of a number takes a third of the space with fewer digits. Millimetres are enough to draw.
double short_number(double value) { return std::round(value * 1e3) * 1e-3; }

Json short_numbers(const Json& numbers) {
  Json rounded = Json::array();
  for (const Json& number : numbers) rounded.push_back(short_number(number.get<double>()));
  return rounded;
}

template <typename Matrix>
Json short_json_of(const Matrix& matrix) {
  return short_numbers(json_of(matrix));
}

Json path_json(const flow::TrackedObject& object) {
  Json path = Json::array();
  for (const flow::PredictedPosition& predicted : object.predicted_path)
    path.push_back({{"after_s", short_number(predicted.after_s)},
                    {"position", short_json_of(predicted.position_in_odom_m)},
                    {"covariance", short_json_of(predicted.covariance_m2)}});
  return path;
}

/// x and y in turn.
Json contour_json(const flow::TrackedObject& object) {
  Json contour = Json::array();
  for (const Eigen::Vector2f& point : object.contour_in_odom_m) {
    contour.push_back(std::round(static_cast<double>(point.x()) * 1e2) * 1e-2);
    contour.push_back(std::round(static_cast<double>(point.y()) * 1e2) * 1e-2);
  }
  return contour;
}

Json track_json(const flow::TrackedObject& object) {
  Json json;
  json["id"] = object.track_id.value;
  json["confirmed"] = object.confirmed;
  json["occluded"] = object.occluded;
  json["existence"] = short_number(object.existence);
  json["position"] = short_json_of(object.position_in_odom_m);
  json["velocity"] = short_json_of(object.velocity_in_odom_mps);
  json["acceleration"] = short_json_of(object.acceleration_in_odom_mps2);
  json["covariance"] = short_json_of(object.covariance);
  json["heading"] = short_number(object.heading_in_odom_rad);
  json["length"] = short_number(object.length_m);
  json["width"] = short_number(object.width_m);
  json["height"] = drawn_height_m(object.object_class);
  json["stopped"] = object.motion == flow::Motion::kStopped;
  json["class"] = name_of(object.object_class);
  json["class_probability"] = short_numbers(object.class_probability);
  json["mode_probability"] = short_numbers(object.mode_probability);
  json["first_seen_ns"] = std::to_string(object.first_seen_ns);
  json["last_seen_ns"] = std::to_string(object.last_seen_ns);
  json["path"] = path_json(object);
  if (object.confirmed) json["contour"] = contour_json(object);
  return json;
}

}  // namespace

std::string tracks_json(const flow::TrackedObjects& objects) {
  Json json;
  json["stamp_ns"] = std::to_string(objects.stamp_ns);
  json["map_from_odom"] = json_of(objects.map_from_odom);
  json["odom_from_base"] = json_of(objects.odom_from_base);
  json["tracks"] = Json::array();
  for (const flow::TrackedObject& object : objects.objects)
    json["tracks"].push_back(track_json(object));
  return json.dump();
}

}  // namespace slammot::gateway
