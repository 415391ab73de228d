#pragma once

#include <string>

#include "common/sensing/odometry_episodes.hpp"

namespace slammot::files {

/// Evaluation of odometry in one line without a full stop: its factors, whether they are accepted,
/// and the longest episodes in which it was rejected. If no time is known, episodes are located by
/// scans.
std::string describe_odometry(const sensing::OdometryConclusions& odometry, bool time_is_known);

/// Name of the fault in the report.
const char* name_of(sensing::OdometryFault fault);

}  // namespace slammot::files
