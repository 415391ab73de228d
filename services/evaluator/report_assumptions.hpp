#pragma once

#include <string>

namespace slammot::evaluator {

/// HTML of what a run assumed of clock, odometry and sensor, and of its findings, by report.json.
/// Empty if the text is no such JSON.
std::string assumptions_section(const std::string& report_json);

/// HTML table of closures by state and reason, by report.json; empty if there are none.
std::string closures_section(const std::string& report_json);

}  // namespace slammot::evaluator
