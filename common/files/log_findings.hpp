#pragma once

#include <string>
#include <vector>

#include "common/files/carmen_survey.hpp"

namespace slammot::files {

/// Way by scans over way by odometry, where the sampled pairs of scans say that it is far from 1; else 1.
double way_factor_of(const LogPlan& plan);

/// What is unusual in a log, and what is done about it: one sentence each, without a full stop; empty for a sound log.
std::vector<std::string> describe_findings(const LogPlan& plan);

/// Where odometry comes from and what a quick match of scans says of it, in one line.
std::string describe_odometry(const LogPlan& plan);

/// All that is known of a log before its first scan is worked on, a line each: "  clock      ...".
std::string describe_log(const LogPlan& plan);

/// What makes a localizer lose its way in this log, most likely first, in one line.
std::string likely_causes(const LogPlan& plan);

/// Lines for the terminal that name the scanners that are used, where there are several; otherwise empty.
std::string describe_scanners(const LogPlan& plan);

/// Name of the fault in the report; "none" for a clock as it should be.
const char* name_of(sensing::ClockFault fault);

}  // namespace slammot::files
