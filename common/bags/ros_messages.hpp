#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "common/bags/message_source.hpp"

namespace slammot::bags {

/// std_msgs/Header.
struct Header {
  std::int64_t stamp_ns = 0;
  std::string frame;  ///< Without the '/' that old ROS puts before it.
};

/// sensor_msgs/LaserScan, or of each beam the first echo of sensor_msgs/MultiEchoLaserScan.
struct LaserScanMessage {
  Header header;
  float first_beam_rad = 0.0F;  ///< angle_min: of the first beam, also where they go clockwise.
  float last_beam_rad = 0.0F;   ///< angle_max
  float beam_step_rad = 0.0F;   ///< angle_increment
  float least_range_m = 0.0F;
  float most_range_m = 0.0F;
  std::vector<float> range_m;
};

/// A frame in its parent frame. Quaternions of any length are normalized when they are parsed.
struct Transform {
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};

/// nav_msgs/Odometry: the pose of child_frame in header.frame.
struct OdometryMessage {
  Header header;
  std::string child_frame;
  Transform pose;
};

/// One of tf2_msgs/TFMessage.
struct TransformMessage {
  Header header;
  std::string child_frame;
  Transform parent_from_child;
};

/// sensor_msgs/Imu.
struct ImuMessage {
  Header header;
  double yaw_rate_radps = 0.0;
};

/// sensor_msgs/PointCloud2.
struct PointCloudMessage {
  Header header;
  std::vector<Eigen::Vector3f> points_m;  ///< Finite ones, in the frame.
};

/// The kinds of messages that are understood here.
enum class MessageKind : std::uint8_t {
  kOther,
  kLaserScan,
  kMultiEcho,
  kOdometry,
  kTransforms,
  kImu,
  kPointCloud
};

/// By the type's name and, where the bag has it, the checksum of its definition: a type of another
/// definition is another type.
MessageKind kind_of(const Channel& channel);

/// Each understands one message of its kind; nullopt for bytes that are none. Counts within the
/// message are never believed beyond its bytes.
std::optional<LaserScanMessage> parse_laser_scan(const RawMessage& message);
std::optional<OdometryMessage> parse_odometry(const RawMessage& message);
std::optional<std::vector<TransformMessage>> parse_transforms(const RawMessage& message);
std::optional<ImuMessage> parse_imu(const RawMessage& message);
std::optional<PointCloudMessage> parse_point_cloud(const RawMessage& message);

/// Why the parser of its kind refuses a message: "its quaternion is all zeros".
std::string why_refused(const RawMessage& message);

}  // namespace slammot::bags
