#include "services/gateway/message_parts.hpp"

#include <cmath>

namespace slammot::gateway {

std::string laser_frame(const std::string& scanner_id) { return "laser_" + scanner_id; }

void set_time(std::int64_t stamp_ns, google::protobuf::Timestamp& timestamp) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  std::int64_t seconds = stamp_ns / kSecond_ns;
  if (stamp_ns % kSecond_ns < 0) --seconds;  // nanos are never negative
  timestamp.set_seconds(seconds);
  timestamp.set_nanos(static_cast<std::int32_t>(stamp_ns - seconds * kSecond_ns));
}

void set_rotation(double heading_rad, foxglove::Quaternion& to) {
  to.set_z(std::sin(0.5 * heading_rad));
  to.set_w(std::cos(0.5 * heading_rad));
}

void set_pose(const geometry::Pose2& pose, double height_m, foxglove::Pose& to) {
  to.mutable_position()->set_x(pose.x_m);
  to.mutable_position()->set_y(pose.y_m);
  to.mutable_position()->set_z(height_m);
  set_rotation(pose.heading_rad, *to.mutable_orientation());
}

void set_color(const Rgba& color, foxglove::Color& to) {
  to.set_r(color.red);
  to.set_g(color.green);
  to.set_b(color.blue);
  to.set_a(color.alpha);
}

}  // namespace slammot::gateway
