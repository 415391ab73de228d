#include "services/gateway/ros2_format.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <exception>
#include <map>
#include <string>
#include <utility>

#include "foxglove.pb.h"
#include "services/gateway/cdr_writer.hpp"
#include "services/gateway/json_parts.hpp"
#include "services/gateway/message_parts.hpp"
#include "services/gateway/ros2_definitions.hpp"

namespace slammot::gateway {
namespace {

struct Ros2Topic {
  ChannelId source;
  const char* name;
  const char* type;
};

constexpr std::array<Ros2Topic, 10> kTopics = {{
    {ChannelId::kScan, "/scan", "sensor_msgs/msg/LaserScan"},
    {ChannelId::kPoints, "/scan/points", "sensor_msgs/msg/PointCloud2"},
    {ChannelId::kTracks, "/tracks", "visualization_msgs/msg/MarkerArray"},
    {ChannelId::kPose, "/pose", "geometry_msgs/msg/PoseStamped"},
    {ChannelId::kTrajectory, "/trajectory", "nav_msgs/msg/Path"},
    {ChannelId::kTransforms, "/tf", "tf2_msgs/msg/TFMessage"},
    {ChannelId::kStationaryMap, "/map/stationary", "nav_msgs/msg/OccupancyGrid"},
    {ChannelId::kMovingMap, "/map/moving", "nav_msgs/msg/OccupancyGrid"},
    {ChannelId::kFix, "/gnss", "sensor_msgs/msg/NavSatFix"},
    {ChannelId::kPoseDetails, "/odom", "nav_msgs/msg/Odometry"},
}};

constexpr std::int32_t kCube = 1, kText = 9;
constexpr std::int32_t kAdd = 0, kDelete = 2;
constexpr double kTextHeight_m = 0.8;
constexpr std::uint8_t kPointFieldOf[] = {0, 2, 1, 4, 3, 6, 5, 7, 8};  ///< Of a NumericType.

void put(const google::protobuf::Timestamp& time, CdrWriter& to) {
  to.put(static_cast<std::int32_t>(time.seconds()));
  to.put(static_cast<std::uint32_t>(time.nanos()));
}

void put_header(const google::protobuf::Timestamp& time, const std::string& frame, CdrWriter& to) {
  put(time, to);
  to.put(std::string_view(frame));
}

template <typename Vector>
void put_vector(const Vector& vector, CdrWriter& to) {
  for (const double value : {vector.x(), vector.y(), vector.z()}) to.put(value);
}

void put(const foxglove::Quaternion& rotation, CdrWriter& to) {
  for (const double value : {rotation.x(), rotation.y(), rotation.z(), rotation.w()}) to.put(value);
}

void put(const foxglove::Pose& pose, CdrWriter& to) {
  put_vector(pose.position(), to);
  put(pose.orientation(), to);
}

void put(const foxglove::Color& color, CdrWriter& to) {
  for (const double value : {color.r(), color.g(), color.b(), color.a()})
    to.put(static_cast<float>(value));
}

/// What a scanner does that is not in a viewer's message.
using Scanners = std::map<std::string, sensing::Scanner>;

void put(const foxglove::LaserScan& scan, const Scanners& scanners, CdrWriter& to) {
  put_header(scan.timestamp(), scan.frame_id(), to);
  const double steps = std::max(1, scan.ranges_size() - 1);
  const auto known = scanners.find(scan.frame_id());
  const double sweep_s = known == scanners.end() ? 0.0 : known->second.sweep_s;
  const double max_range_m = known == scanners.end() ? 0.0 : known->second.max_range_m;
  for (const double value :
       {scan.start_angle(), scan.end_angle(), (scan.end_angle() - scan.start_angle()) / steps,
        sweep_s / steps, 0.0, 0.0, max_range_m})
    to.put(static_cast<float>(value));
  to.put_count(static_cast<std::size_t>(scan.ranges_size()));
  for (const double range_m : scan.ranges()) to.put(static_cast<float>(range_m));
  to.put_count(0);  // intensities
}

void put_field(std::string_view name, std::uint32_t offset,
               foxglove::PackedElementField::NumericType type, CdrWriter& to) {
  to.put(name);
  to.put(offset);
  to.put(kPointFieldOf[static_cast<std::size_t>(type)]);
  to.put(std::uint32_t{1});
}

/// With z = 0 at the end of each point, as all who read clouds expect three coordinates.
void put(const foxglove::PointCloud& cloud, CdrWriter& to) {
  const std::uint32_t stride = cloud.point_stride() + sizeof(float);
  std::string data;
  std::uint32_t points = 0;
  for (std::size_t at = 0;
       at + cloud.point_stride() <= cloud.data().size() && stride > sizeof(float);
       at += cloud.point_stride(), ++points) {
    data.append(cloud.data(), at, cloud.point_stride());
    data.append(sizeof(float), '\0');
  }
  put_header(cloud.timestamp(), cloud.frame_id(), to);
  to.put(std::uint32_t{1});
  to.put(points);
  to.put_count(static_cast<std::size_t>(cloud.fields_size()) + 1);
  for (const foxglove::PackedElementField& field : cloud.fields())
    put_field(field.name(), field.offset(), field.type(), to);
  put_field("z", cloud.point_stride(), foxglove::PackedElementField::FLOAT32, to);
  to.put(std::uint8_t{0});  // little-endian
  to.put(stride);
  to.put(points * stride);
  to.put_bytes(data);
  to.put(std::uint8_t{1});  // no NaN
}

std::int32_t number_of(const std::string& id) {
  std::int32_t number = 0;
  const std::size_t digits = id.find_first_of("0123456789");
  if (digits != std::string::npos)
    std::from_chars(id.data() + digits, id.data() + id.size(), number);
  return number;
}

struct Marker {
  google::protobuf::Timestamp time;
  std::string frame_id;
  std::string_view space;
  std::int32_t id = 0;
  std::int32_t type = kCube;
  std::int32_t action = kAdd;
  foxglove::Pose pose;
  foxglove::Vector3 scale;
  foxglove::Color color;
  google::protobuf::Duration lifetime;
  std::string_view text;
};

void put(const Marker& marker, CdrWriter& to) {
  put_header(marker.time, marker.frame_id, to);
  to.put(marker.space);
  for (const std::int32_t value : {marker.id, marker.type, marker.action}) to.put(value);
  put(marker.pose, to);
  put_vector(marker.scale, to);
  put(marker.color, to);
  to.put(static_cast<std::int32_t>(marker.lifetime.seconds()));
  to.put(static_cast<std::uint32_t>(marker.lifetime.nanos()));
  to.put(std::uint8_t{0});  // frame_locked
  to.put_count(0);          // points
  to.put_count(0);          // colors
  to.put(std::string_view());
  put_header({}, {}, to);  // texture
  to.put(std::string_view());
  to.put_count(0);
  to.put_count(0);  // uv_coordinates
  to.put(marker.text);
  to.put(std::string_view());
  to.put(std::string_view());  // mesh_file
  to.put_count(0);
  to.put(std::uint8_t{0});
}

std::vector<Marker> markers_of(const foxglove::SceneUpdate& scene) {
  std::vector<Marker> markers;
  for (const foxglove::SceneEntityDeletion& deletion : scene.deletions()) {
    for (const auto& [space, type] : {std::pair("box", kCube), std::pair("label", kText)}) {
      Marker marker;
      marker.time = deletion.timestamp();
      marker.frame_id = kOdomFrame;
      marker.space = space;
      marker.id = number_of(deletion.id());
      marker.type = type;
      marker.action = kDelete;
      markers.push_back(std::move(marker));
    }
  }
  for (const foxglove::SceneEntity& entity : scene.entities()) {
    Marker marker;
    marker.time = entity.timestamp();
    marker.frame_id = entity.frame_id();
    marker.id = number_of(entity.id());
    marker.lifetime = entity.lifetime();
    for (const foxglove::CubePrimitive& cube : entity.cubes()) {
      marker.space = "box";
      marker.type = kCube;
      marker.pose = cube.pose();
      marker.scale = cube.size();
      marker.color = cube.color();
      markers.push_back(marker);
    }
    for (const foxglove::TextPrimitive& text : entity.texts()) {
      marker.space = "label";
      marker.type = kText;
      marker.pose = text.pose();
      marker.scale.set_z(kTextHeight_m);
      marker.color = text.color();
      marker.text = text.text();
      markers.push_back(marker);
    }
  }
  return markers;
}

void put(const foxglove::SceneUpdate& scene, CdrWriter& to) {
  const std::vector<Marker> markers = markers_of(scene);
  to.put_count(markers.size());
  for (const Marker& marker : markers) put(marker, to);
}

void put(const foxglove::PoseInFrame& pose, CdrWriter& to) {
  put_header(pose.timestamp(), pose.frame_id(), to);
  put(pose.pose(), to);
}

void put(const foxglove::PosesInFrame& path, CdrWriter& to) {
  put_header(path.timestamp(), path.frame_id(), to);
  to.put_count(static_cast<std::size_t>(path.poses_size()));
  for (const foxglove::Pose& pose : path.poses()) {
    put_header(path.timestamp(), path.frame_id(), to);
    put(pose, to);
  }
}

void put(const foxglove::FrameTransforms& message, CdrWriter& to) {
  to.put_count(static_cast<std::size_t>(message.transforms_size()));
  for (const foxglove::FrameTransform& transform : message.transforms()) {
    put_header(transform.timestamp(), transform.parent_frame_id(), to);
    to.put(std::string_view(transform.child_frame_id()));
    put_vector(transform.translation(), to);
    put(transform.rotation(), to);
  }
}

/// -1: never seen; else percent, by the opacity of the cell: that of free space is in between.
std::string occupancy_of(const foxglove::Grid& grid, bool is_of_moving) {
  std::string cells;
  cells.reserve(grid.data().size() / 4);
  for (std::size_t at = 3; at < grid.data().size(); at += 4) {
    const auto opacity = static_cast<std::uint8_t>(grid.data()[at]);
    cells += static_cast<char>(opacity == 0     ? -1
                               : is_of_moving   ? 100 * opacity / 255
                               : opacity == 255 ? 100
                                                : 0);
  }
  return cells;
}

void put(const foxglove::Grid& grid, bool is_of_moving, CdrWriter& to) {
  const std::string cells = occupancy_of(grid, is_of_moving);
  put_header(grid.timestamp(), grid.frame_id(), to);
  put(grid.timestamp(), to);
  to.put(static_cast<float>(grid.cell_size().x()));
  to.put(grid.column_count());
  to.put(grid.column_count() == 0 ? 0U
                                  : static_cast<std::uint32_t>(cells.size() / grid.column_count()));
  put(grid.pose(), to);
  to.put_bytes(cells);
}

void put(const foxglove::LocationFix& fix, CdrWriter& to) {
  const bool has_fix = fix.position_covariance_size() == 9;
  put_header(fix.timestamp(), fix.frame_id(), to);
  to.put(static_cast<std::int8_t>(has_fix ? 0 : -1));
  to.put(std::uint16_t{1});  // GPS
  for (const double value : {fix.latitude(), fix.longitude(), fix.altitude()}) to.put(value);
  for (int i = 0; i < 9; ++i) to.put(has_fix ? fix.position_covariance(i) : 0.0);
  to.put(static_cast<std::uint8_t>(fix.position_covariance_type()));
}

/// 6 x 6 of (x, y, z, roll, pitch, yaw) from 3 x 3 of (x, y, heading).
void put_covariance(const Json& covariance, CdrWriter& to) {
  constexpr std::array<int, 6> kOf = {0, 1, -1, -1, -1, 2};
  for (const int row : kOf) {
    for (const int column : kOf)
      to.put(row < 0 || column < 0
                 ? 0.0
                 : covariance.at(static_cast<std::size_t>(3 * row + column)).get<double>());
  }
}

/// Throws for what is no message of kPoseDetails.
void put_odometry(const Json& details, CdrWriter& to) {
  google::protobuf::Timestamp time;
  set_time(std::stoll(details.at("stamp_ns").get<std::string>()), time);
  put_header(time, kOdomFrame, to);
  to.put(std::string_view(kBaseFrame));
  const Json& pose = details.at("odom_from_base");
  foxglove::Pose in_odom;
  set_pose({pose.at(0).get<double>(), pose.at(1).get<double>(), pose.at(2).get<double>()}, 0.0,
           in_odom);
  put(in_odom, to);
  put_covariance(details.at("covariance"), to);
  for (const double value : {details.at("speed_mps").get<double>(), 0.0, 0.0, 0.0, 0.0,
                             details.at("yaw_rate_radps").get<double>()})
    to.put(value);
  for (int i = 0; i < 36; ++i) to.put(0.0);  // unknown
}

bool put_odometry_of(const std::string& payload, CdrWriter& to) {
  try {
    put_odometry(Json::parse(payload), to);
    return true;
  } catch (const std::exception&) { return false; }  // of nlohmann::json, or of a number's text
}

class Ros2Format : public MessageFormat {
 public:
  std::string profile() const override { return "ros2"; }

  std::vector<Topic> topics() const override {
    std::vector<Topic> topics;
    for (const Ros2Topic& topic : kTopics) {
      const std::string definition = ros2_definition(topic.type);
      topics.push_back({topic.source,
                        topic.name,
                        {0, topic.type, "ros2msg", {definition.begin(), definition.end()}},
                        "cdr"});
    }
    return topics;
  }

  void know(const sensing::Scanner& scanner) override {
    scanners_[laser_frame(scanner.scanner_id)] = scanner;
  }

  std::optional<std::string> encoded(ChannelId source, std::string payload) const override {
    CdrWriter to;
    const auto from = [&](auto message, const auto&... more) {
      if (!message.ParseFromString(payload)) return false;
      put(message, more..., to);
      return true;
    };
    const auto is_understood = [&] {
      switch (source) {
        case ChannelId::kScan: return from(foxglove::LaserScan(), scanners_);
        case ChannelId::kPoints: return from(foxglove::PointCloud());
        case ChannelId::kTracks: return from(foxglove::SceneUpdate());
        case ChannelId::kPose: return from(foxglove::PoseInFrame());
        case ChannelId::kTrajectory: return from(foxglove::PosesInFrame());
        case ChannelId::kTransforms: return from(foxglove::FrameTransforms());
        case ChannelId::kStationaryMap: return from(foxglove::Grid(), false);
        case ChannelId::kMovingMap: return from(foxglove::Grid(), true);
        case ChannelId::kFix: return from(foxglove::LocationFix());
        case ChannelId::kPoseDetails: return put_odometry_of(payload, to);
        default: return false;
      }
    };
    if (!is_understood()) return std::nullopt;
    return std::move(to).take();
  }

 private:
  Scanners scanners_;
};

}  // namespace

std::unique_ptr<MessageFormat> ros2_format() { return std::make_unique<Ros2Format>(); }

}  // namespace slammot::gateway
