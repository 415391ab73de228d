#pragma once

#include <string>
#include <vector>

#include "common/files/log_plan.hpp"

namespace slammot::files {

/// Way by scans over way by odometry, if the sampled pairs of scans show that it is far from 1;
/// else 1.
double way_factor_of(const LogPlan& plan);

/// False if scans see so little, by the share of beams with an echo and the share of sampled pairs
/// that match, that what they match is mostly traffic: they are no evidence against odometry. True
/// where no pair was tried.
bool scans_show_motion(const LogPlan& plan);

/// Defects of a log and their treatment: one sentence each, without a full stop; empty for a log
/// without defects.
std::vector<std::string> describe_findings(const LogPlan& plan);

/// Of these, which scanners look down at the floor. Known after the drive where no log is read
/// twice.
std::vector<std::string> describe_floor(const LogPlan& plan);

/// True if a scanner looks down at the floor, and its echoes of it are in the scans.
bool takes_floor_for_wall(const LogPlan& plan);

/// Source of odometry and its evaluation by matched pairs of scans, in one line.
std::string describe_odometry(const LogPlan& plan);

/// Summary of a log before its first scan is processed, a line each: "  clock      ...".
std::string describe_log(const LogPlan& plan);

/// Likely causes of a loss of localization in this log, most likely first, in one line.
std::string likely_causes(const LogPlan& plan);

/// Terminal lines with the names of the used scanners, if there are several, and of those that scan
/// vertically; otherwise empty.
std::string describe_scanners(const LogPlan& plan);

/// Name of the fault in the report; "none" for a clock without fault.
const char* name_of(sensing::ClockFault fault);

}  // namespace slammot::files
