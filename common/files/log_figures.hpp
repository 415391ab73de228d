#pragma once

#include "common/files/log_plan.hpp"
#include "common/files/scanner_survey.hpp"

namespace slammot::files {

/// Statistics of the main scanner. The plan knows clock, corrections and max_range_m.
/// fallback_field_of_view_rad: from the first to the last beam, for records without one.
LogFigures log_figures_of(const ScannerSurvey& scanner, const LogPlan& plan,
                          double fallback_field_of_view_rad);

}  // namespace slammot::files
