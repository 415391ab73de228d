#pragma once

#include <string>

#include "common/sensing/odometry_episodes.hpp"

namespace slammot::files {

/// What was concluded of odometry, in one line without a full stop: its factors, whether they are believed, and the longest episodes in
/// which it was not. Where no time is known, episodes are told by scans.
std::string describe_odometry(const sensing::OdometryConclusions& odometry, bool time_is_known);

/// Name of the fault in the report.
const char* name_of(sensing::OdometryFault fault);

}  // namespace slammot::files
