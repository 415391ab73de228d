#pragma once

#include "common/files/log_plan.hpp"
#include "common/files/scanner_survey.hpp"

namespace slammot::files {

/// Decides where odometry comes from, what its stamps are worth and whether it is smoothed or left
/// out: sets odometry and the odometry_* of the plan but odometry_lines. The plan knows clock,
/// corrections, scanners and figures. lines: those of plan.odometry_lines.
void plan_odometry(const ScannerSurvey& scanner, const OdometryLines& lines,
                   double fallback_field_of_view_rad, LogPlan& plan);

}  // namespace slammot::files
