#pragma once

#include <string>
#include <string_view>

namespace slammot::gateway {

/// Definition of a message type of ROS 2 ("sensor_msgs/msg/LaserScan") with those of its parts, as
/// MCAP's schema encoding "ros2msg" wants them: after the type's own fields, each part follows a
/// line of "=" and its name. Fields are those of ROS 2 Humble's interface packages.
std::string ros2_definition(std::string_view type);

}  // namespace slammot::gateway
