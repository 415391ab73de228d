#pragma once

#include <memory>

#include "services/gateway/viewer_file.hpp"

namespace slammot::gateway {

/// Standard messages of ROS 2: LaserScan, PointCloud2, MarkerArray (tracks), PoseStamped, Path,
/// TFMessage, OccupancyGrid, NavSatFix and Odometry, in plain CDR, each with its definition, as
/// rosbag2 stores them in MCAP. What ROS has no standard message for is left out.
std::unique_ptr<MessageFormat> ros2_format();

}  // namespace slammot::gateway
