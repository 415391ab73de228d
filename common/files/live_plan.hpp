#pragma once

#include "common/files/log_plan.hpp"

namespace slammot::files {

/// The plan of a log that is read as live sensors would publish it: in metres, radians and its
/// clock, with every fault of mounting, odometry and stamps that a survey of the whole log corrects
/// before the first scan.
LogPlan as_live(LogPlan plan);

}  // namespace slammot::files
