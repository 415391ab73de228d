#pragma once

#include <filesystem>
#include <optional>

#include "common/files/result.hpp"
#include "common/files/run_record.hpp"

namespace CLI {
class App;
}

namespace slammot::evaluator {

inline constexpr const char* kReportFile = "report.html";

/// Adds `slammot report`: an HTML page about a run, or about two. `exit_code` is set when the
/// command has run and must outlive `app`.
void add_report_command(CLI::App& app, int& exit_code);

/// Writes report.html into the folder of a run that has just ended: `record` with the files that
/// the run wrote there. Without ground truth.
std::optional<files::Error> write_report_of(const files::RunRecord& record,
                                            const std::filesystem::path& folder);

}  // namespace slammot::evaluator
