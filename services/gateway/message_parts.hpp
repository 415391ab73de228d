#pragma once

#include <cstdint>
#include <string>

#include "common/geometry/pose2.hpp"
#include "foxglove.pb.h"

/// Parts that all messages for viewers share.
namespace slammot::gateway {

inline constexpr const char* kMapFrame = "map";
inline constexpr const char* kOdomFrame = "odom";
inline constexpr const char* kBaseFrame = "base";

/// "laser_front" of scanner "front".
std::string laser_frame(const std::string& scanner_id);

void set_time(std::int64_t stamp_ns, google::protobuf::Timestamp& timestamp);

/// In the plane z = height_m.
void set_pose(const geometry::Pose2& pose, double height_m, foxglove::Pose& to);

void set_rotation(double heading_rad, foxglove::Quaternion& to);

struct Rgba {
  double red = 0.0;
  double green = 0.0;
  double blue = 0.0;
  double alpha = 1.0;
};
void set_color(const Rgba& color, foxglove::Color& to);

}  // namespace slammot::gateway
