#include <cmath>
#include <string>
#include <vector>

#include "services/gateway/message_parts.hpp"
#include "services/gateway/track_messages.hpp"

namespace slammot::gateway {
namespace {

constexpr double kLeastArrowSpeed_mps = 0.3;
constexpr std::int32_t kLifetime_s = 2;  ///< Tracks vanish where the gateway falls silent.

Rgba color_of(flow::ObjectClass object_class) {
  switch (object_class) {
    case flow::ObjectClass::kPedestrian: return {0.80, 0.47, 0.65, 0.8};
    case flow::ObjectClass::kBicycle: return {0.0, 0.62, 0.45, 0.8};
    case flow::ObjectClass::kCar: return {0.90, 0.48, 0.0, 0.8};
    case flow::ObjectClass::kTruckOrBus: return {0.84, 0.37, 0.0, 0.8};
    case flow::ObjectClass::kUnknown: break;
  }
  return {0.6, 0.6, 0.6, 0.8};
}

std::string entity_id(flow::TrackId track_id) { return "track_" + std::to_string(track_id.value); }

/// In the entity's frame, odom.
geometry::Pose2 pose_of(const flow::TrackedObject& object) {
  return {object.position_in_odom_m.x(), object.position_in_odom_m.y(), object.heading_in_odom_rad};
}

void add_box(const flow::TrackedObject& object, foxglove::SceneEntity& entity) {
  const double height_m = drawn_height_m(object.object_class);
  foxglove::CubePrimitive& cube = *entity.add_cubes();
  set_pose(pose_of(object), 0.5 * height_m, *cube.mutable_pose());
  cube.mutable_size()->set_x(object.length_m);
  cube.mutable_size()->set_y(object.width_m);
  cube.mutable_size()->set_z(height_m);
  set_color(color_of(object.object_class), *cube.mutable_color());
}

/// As long as the way of the next second.
void add_arrow(const flow::TrackedObject& object, foxglove::SceneEntity& entity) {
  const Eigen::Vector2d& velocity = object.velocity_in_odom_mps;
  if (velocity.norm() < kLeastArrowSpeed_mps) return;
  foxglove::ArrowPrimitive& arrow = *entity.add_arrows();
  geometry::Pose2 tail = pose_of(object);
  tail.heading_rad = std::atan2(velocity.y(), velocity.x());
  set_pose(tail, drawn_height_m(object.object_class), *arrow.mutable_pose());
  arrow.set_shaft_length(0.8 * velocity.norm());
  arrow.set_shaft_diameter(0.12);
  arrow.set_head_length(0.2 * velocity.norm());
  arrow.set_head_diameter(0.4);
  set_color({0.95, 0.9, 0.25, 1.0}, *arrow.mutable_color());
}

void add_path(const flow::TrackedObject& object, foxglove::SceneEntity& entity) {
  if (object.predicted_path.empty()) return;
  foxglove::LinePrimitive& line = *entity.add_lines();
  line.set_type(foxglove::LinePrimitive::LINE_STRIP);
  set_pose({}, 0.1, *line.mutable_pose());
  line.set_thickness(2.0);
  line.set_scale_invariant(true);
  set_color(color_of(object.object_class), *line.mutable_color());
  const auto add = [&](const Eigen::Vector2d& position) {
    foxglove::Point3& point = *line.add_points();
    point.set_x(position.x());
    point.set_y(position.y());
  };
  add(object.position_in_odom_m);
  for (const flow::PredictedPosition& predicted : object.predicted_path)
    add(predicted.position_in_odom_m);
}

/// Lines between neighbouring points.
void add_contour(const flow::TrackedObject& object, foxglove::SceneEntity& entity) {
  constexpr float kNeighboursM = 1.2F;  // farther apart nothing was seen between them
  const std::vector<Eigen::Vector2f>& contour = object.contour_in_odom_m;
  foxglove::LinePrimitive& line = *entity.add_lines();
  line.set_type(foxglove::LinePrimitive::LINE_LIST);
  set_pose({}, 0.2, *line.mutable_pose());
  line.set_thickness(3.0);
  line.set_scale_invariant(true);
  set_color(color_of(object.object_class), *line.mutable_color());
  for (std::size_t i = 0; i < contour.size(); ++i) {
    const Eigen::Vector2f& next = contour[(i + 1) % contour.size()];
    if ((next - contour[i]).norm() > kNeighboursM) continue;
    for (const Eigen::Vector2f& at : {contour[i], next}) {
      foxglove::Point3& point = *line.add_points();
      point.set_x(static_cast<double>(at.x()));
      point.set_y(static_cast<double>(at.y()));
    }
  }
}

void add_label(const flow::TrackedObject& object, foxglove::SceneEntity& entity) {
  foxglove::TextPrimitive& text = *entity.add_texts();
  set_pose({object.position_in_odom_m.x(), object.position_in_odom_m.y(), 0.0},
           drawn_height_m(object.object_class) + 0.8, *text.mutable_pose());
  text.set_billboard(true);
  text.set_scale_invariant(true);
  text.set_font_size(12.0);
  set_color({1.0, 1.0, 1.0, 1.0}, *text.mutable_color());
  text.set_text(std::string(name_of(object.object_class)) + " " +
                std::to_string(object.track_id.value));
}

void add_entity(const flow::TrackedObjects& objects, const flow::TrackedObject& object,
                foxglove::SceneUpdate& message) {
  foxglove::SceneEntity& entity = *message.add_entities();
  set_time(objects.stamp_ns, *entity.mutable_timestamp());
  entity.set_frame_id(kOdomFrame);
  entity.set_id(entity_id(object.track_id));
  entity.mutable_lifetime()->set_seconds(kLifetime_s);
  add_box(object, entity);
  add_arrow(object, entity);
  add_path(object, entity);
  add_contour(object, entity);
  add_label(object, entity);
}

}  // namespace

std::string_view name_of(flow::ObjectClass object_class) {
  switch (object_class) {
    case flow::ObjectClass::kPedestrian: return "pedestrian";
    case flow::ObjectClass::kBicycle: return "bicycle";
    case flow::ObjectClass::kCar: return "car";
    case flow::ObjectClass::kTruckOrBus: return "truck or bus";
    case flow::ObjectClass::kUnknown: break;
  }
  return "unknown";
}

double drawn_height_m(flow::ObjectClass object_class) {
  switch (object_class) {
    case flow::ObjectClass::kPedestrian:
    case flow::ObjectClass::kBicycle: return 1.75;
    case flow::ObjectClass::kTruckOrBus: return 3.0;
    case flow::ObjectClass::kCar: return 1.5;
    case flow::ObjectClass::kUnknown: break;
  }
  return 1.0;
}

std::set<flow::TrackId> drawn_tracks(const flow::TrackedObjects& objects) {
  std::set<flow::TrackId> drawn;
  for (const flow::TrackedObject& object : objects.objects) {
    if (object.confirmed) drawn.insert(object.track_id);
  }
  return drawn;
}

foxglove::SceneUpdate scene_message(const flow::TrackedObjects& objects,
                                    const std::set<flow::TrackId>& shown) {
  foxglove::SceneUpdate message;
  const std::set<flow::TrackId> drawn = drawn_tracks(objects);
  for (const flow::TrackId track_id : shown) {
    if (drawn.contains(track_id)) continue;
    foxglove::SceneEntityDeletion& deletion = *message.add_deletions();
    set_time(objects.stamp_ns, *deletion.mutable_timestamp());
    deletion.set_type(foxglove::SceneEntityDeletion::MATCHING_ID);
    deletion.set_id(entity_id(track_id));
  }
  for (const flow::TrackedObject& object : objects.objects) {
    if (object.confirmed) add_entity(objects, object, message);
  }
  return message;
}

}  // namespace slammot::gateway
