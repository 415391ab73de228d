#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "common/files/log_plan.hpp"
#include "common/files/scanner_survey.hpp"
#include "common/sensing/scan_times.hpp"

namespace slammot::files {

/// Recorded stamps of one of the two clocks, with the way between scans by the plan's odometry
/// lines and corrections.
std::vector<sensing::ScanMark> scan_marks_of(const ScannerSurvey& scanner, const LogPlan& plan,
                                             LogClock clock);

/// Chooses a faultless clock, ipc before logger; otherwise one that can be repaired; otherwise
/// derives time from the way. Sets clock, times and first_scan_is_ahead of the plan, which knows
/// the corrections and max_range_m.
void choose_clock(const ScannerSurvey& scanner, LogPlan& plan);

/// By the chosen clock; none where one is missing.
std::vector<std::int64_t> scan_stamps_of(const ScannerSurvey& scanner, const LogPlan& plan);

/// As CarmenSurvey::clock_of_disordered_scans().
std::optional<LogClock> clock_of_disordered_scans(const std::deque<ScannerSurvey>& scanners);

}  // namespace slammot::files
