#pragma once

#include <string>

#include "common/sensing/gyro_odometry.hpp"
#include "common/sensing/odometry_episodes.hpp"

namespace slammot::files {

/// Evaluation of odometry in one line without a full stop: its factors, whether they are accepted,
/// and the longest episodes in which it was rejected. If no time is known, episodes are located by
/// scans.
std::string describe_odometry(const sensing::OdometryConclusions& odometry, bool time_is_known);

/// What was made of the IMU's turn rate, and why if it was not used, in one line without a full
/// stop.
std::string describe_gyro(const sensing::GyroUse& gyro);

/// Name of the fault in the report.
const char* name_of(sensing::OdometryFault fault);

}  // namespace slammot::files
