#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "common/files/carmen_log.hpp"
#include "common/files/result.hpp"
#include "common/files/run_record.hpp"
#include "common/files/run_report.hpp"
#include "services/slammot/profile.hpp"

namespace CLI {
class App;
}

namespace slammot {

/// Options of `run` and `bench`.
struct JobOptions {
  std::filesystem::path input;        ///< Recorded drive; excludes scenario.
  std::string scenario;               ///< Simulated drive; excludes input.
  std::optional<std::uint64_t> seed;  ///< Replaces the scenario's seed.
  std::filesystem::path output;
  std::string profile;           ///< Name or file; empty: chosen from the log.
  std::filesystem::path config;  ///< Overlaid onto the profile; may be empty.
  files::TopicOptions topics{};  ///< Selection of scanners and topics.
  std::string speed = "max";     ///< Multiple of the recorded rate, or "max".
  std::filesystem::path map{};   ///< Stored map in which the drive begins; may be empty.
  bool stores_map = false;       ///< Writes the map into the output folder.
  bool is_as_live = false;       ///< Takes a log as live sensors publish it.
  bool is_quiet = false;         ///< Prints warnings and faults only.
  bool skips_report = false;     ///< Writes no report.html.
};

/// An opened drive and the settings to process it with.
struct Job {
  files::CarmenLog log;
  Profile profile;
  std::string profile_name;
  std::string profile_reason;
  double sweep_s = 0.0;
  std::optional<double> speed;  ///< Multiple of the recorded rate; empty: as fast as possible.
};

void add_job_options(CLI::App& command, JobOptions& options);

/// A fault of the command line itself, before any file is opened but that of a profile.
std::optional<files::Error> find_usage_fault(const JobOptions& options);

/// Opens the log or begins the simulation, selects and loads the settings, and creates the output
/// folder. Errors in what the options name are reported here, before processing. A simulated drive
/// writes its ground truth into the output folder: truth.tum, truth.objects.csv and
/// truth.walls.csv.
files::Result<Job> prepare_job(const JobOptions& options);

inline constexpr const char* kSettingsFile = "settings.textproto";

/// Writes all settings of a job into its result folder. With --config they reproduce the results.
std::optional<files::Error> write_settings(const Profile& profile,
                                           const std::filesystem::path& folder);

/// Stamps of all scans in the log's order. Reads the log to its end.
std::vector<std::int64_t> stamps_of(files::CarmenLog& log);

/// The part of the report that is known from the job.
files::RunReport report_of(const Job& job, const JobOptions& options, const std::string& command);

/// Writes report.html into the results, unless the options leave it out. A fault is a warning: the
/// results are complete without it.
void write_report(const JobOptions& options, const files::RunRecord& record);

/// Prints on standard output; of a quiet job only the lines that begin with "warning:", on standard
/// error.
void print(const JobOptions& options, const std::string& text);

/// Greatest resident memory of this process so far [MB].
double peak_memory_mb();

}  // namespace slammot
