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

/// What `run` and `bench` are asked for.
struct JobOptions {
  std::filesystem::path input;  ///< Of a recorded drive,
  std::string scenario;         ///< or of a simulated one; exactly one of the two is not empty.
  std::optional<std::uint64_t> seed;  ///< In place of the scenario's own.
  std::filesystem::path output;
  std::string profile;           ///< Name or file; empty: the log's own figures choose.
  std::filesystem::path config;  ///< Overlaid onto the profile; may be empty.
  files::TopicOptions topics{};  ///< Where the log leaves a choice.
  std::string speed = "max";     ///< Times the recorded rate, or "max".
  std::filesystem::path map{};   ///< Stored map to go on in; may be empty.
  bool stores_map = false;       ///< Writes the map into the output folder, for the next.
};

/// A drive, recorded or simulated, understood, and the settings to work on it with.
struct Job {
  files::CarmenLog log;
  Profile profile;
  std::string profile_name;
  std::string profile_reason;
  double sweep_s = 0.0;
  std::optional<double> speed;  ///< Times the recorded rate; none: as fast as possible.
};

void add_job_options(CLI::App& command, JobOptions& options);

/// Opens the log or begins to simulate, chooses and loads the settings, and makes the output
/// folder: every fault a user can make shows here, before the work. The truth of a simulated drive
/// is written into the output folder as it goes on: truth.tum, truth.objects.csv and
/// truth.walls.csv.
files::Result<Job> prepare_job(const JobOptions& options);

inline constexpr const char* kSettingsFile = "settings.textproto";

/// Writes all settings of a job into its folder of results: with --config they give the same
/// results again.
std::optional<files::Error> write_settings(const Profile& profile,
                                           const std::filesystem::path& folder);

/// Stamps of all scans of the log, in its order. The log is read to its end.
std::vector<std::int64_t> stamps_of(files::CarmenLog& log);

/// "log: ..." and "profile: ..." for the terminal.
std::string describe_job(const Job& job, const JobOptions& options);

/// What was driven, as the report names it.
std::string name_of_drive(const JobOptions& options);

/// The report's part that is known from the job.
files::RunReport report_of(const Job& job, const JobOptions& options, const std::string& command);

/// What the user wants to know at the end: counts, latencies, speed, what was wrong with the log,
/// where the outputs are.
std::string describe_outcome(const files::RunRecord& record, const files::RunReport& report,
                             const std::filesystem::path& output);

/// " (the chunk at byte 1234 does not unpack)" where that is known of a damaged log; empty
/// otherwise.
std::string where_damaged(const files::LogFaults& faults);

/// Memory this process had at most.
double peak_memory_mb();

}  // namespace slammot
