#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/files/run_record.hpp"
#include "common/files/run_report.hpp"
#include "services/slammot/job.hpp"

namespace slammot {

/// "log: ..." and "profile: ..." for the terminal.
std::string describe_job(const Job& job, const JobOptions& options);

/// Name of the drive in the report.
std::string name_of_drive(const JobOptions& options);

/// Summary for the terminal: counts, latencies, speed, faults of the log, output folder.
std::string describe_outcome(const files::RunRecord& record, const files::RunReport& report,
                             const std::filesystem::path& output);

/// A warning if the output folder holds files of an earlier run that this one does not replace;
/// empty otherwise.
std::string describe_leftovers(const JobOptions& options);

/// Lines of the log that were skipped while it was read, one sentence for each kind.
std::vector<std::string> describe_skipped(const files::LogFaults& faults);

/// Place of the damage, such as " (the chunk at byte 1234 does not unpack)"; empty if unknown.
std::string where_damaged(const files::LogFaults& faults);

/// Says on stderr that the log is cut off or damaged, if it is. Returns the exit code of a command
/// that has processed it.
int report_damage(const std::filesystem::path& log, const files::LogFaults& faults);

}  // namespace slammot
