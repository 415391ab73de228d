#include "services/gateway/pose_messages.hpp"

#include "services/gateway/json_parts.hpp"
#include "services/gateway/message_parts.hpp"

namespace slammot::gateway {
namespace {

void add_transform(std::int64_t stamp_ns, const std::string& parent, const std::string& child,
                   const geometry::Pose2& parent_from_child, foxglove::FrameTransforms& message) {
  foxglove::FrameTransform& transform = *message.add_transforms();
  set_time(stamp_ns, *transform.mutable_timestamp());
  transform.set_parent_frame_id(parent);
  transform.set_child_frame_id(child);
  transform.mutable_translation()->set_x(parent_from_child.x_m);
  transform.mutable_translation()->set_y(parent_from_child.y_m);
  set_rotation(parent_from_child.heading_rad, *transform.mutable_rotation());
}

}  // namespace

foxglove::PoseInFrame pose_message(const flow::LocalizedScan& scan) {
  foxglove::PoseInFrame message;
  set_time(scan.stamp_ns, *message.mutable_timestamp());
  message.set_frame_id(kMapFrame);
  set_pose(scan.map_from_odom * scan.odom_from_base.pose, 0.0, *message.mutable_pose());
  return message;
}

foxglove::FrameTransforms transforms_message(const flow::LocalizedScan& scan) {
  foxglove::FrameTransforms message;
  add_transform(scan.stamp_ns, kMapFrame, kOdomFrame, scan.map_from_odom, message);
  add_transform(scan.stamp_ns, kOdomFrame, kBaseFrame, scan.odom_from_base.pose, message);
  add_transform(scan.stamp_ns, kBaseFrame, laser_frame(scan.scanner_id), scan.base_from_laser,
                message);
  return message;
}

foxglove::PosesInFrame poses_message(std::int64_t stamp_ns,
                                     const std::vector<geometry::Pose2>& map_from_base) {
  foxglove::PosesInFrame message;
  set_time(stamp_ns, *message.mutable_timestamp());
  message.set_frame_id(kMapFrame);
  for (const geometry::Pose2& pose : map_from_base) set_pose(pose, 0.0, *message.add_poses());
  return message;
}

std::string pose_json(const flow::LocalizedScan& scan) {
  Json json;
  json["stamp_ns"] = std::to_string(scan.stamp_ns);
  json["scanner"] = scan.scanner_id;
  json["base_from_laser"] = json_of(scan.base_from_laser);
  json["map_from_odom"] = json_of(scan.map_from_odom);
  json["odom_from_base"] = json_of(scan.odom_from_base.pose);
  json["covariance"] = json_of(scan.odom_from_base.covariance);
  json["speed_mps"] = scan.speed_mps;
  json["yaw_rate_radps"] = scan.yaw_rate_radps;
  json["map"] = std::to_string(scan.map_id.value);
  json["odom"] = std::to_string(scan.odom_id.value);
  json["submap"] = scan.submap_id.value;
  json["submap_from_base"] = json_of(scan.submap_from_base);
  return json.dump();
}

}  // namespace slammot::gateway
