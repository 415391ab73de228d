#include "common/files/recorded_odometry.hpp"

#include "common/files/pose_difference.hpp"

namespace slammot::files {

void RecordedStamps::add(const CarmenStamps& stamps) {
  ipc_ns.push_back(stamps.ipc_ns);
  logger_ns.push_back(stamps.logger_ns);
}

void RecordedPoses::add(const geometry::Pose2& wheel_from_base) {
  all.push_back(wheel_from_base);
  change = change || differ(all.front(), wheel_from_base, 1e-9, 1e-9);
  check.add(wheel_from_base);
  noise.add(wheel_from_base);
}

}  // namespace slammot::files
