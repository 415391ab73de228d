#include "services/slammot/job.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <sstream>

#include <sys/resource.h>
#include <CLI/CLI.hpp>

#include "common/config/print.hpp"
#include "common/config/profiles.hpp"
#include "common/files/atomic_file.hpp"
#include "common/files/log_findings.hpp"
#include "common/files/log_profile.hpp"
#include "common/files/number_option.hpp"
#include "services/evaluator/report_command.hpp"
#include "services/ingest/log_source.hpp"
#include "services/ingest/topic_arguments.hpp"
#include "services/simulator/live_drive.hpp"
#include "services/simulator/scenario_files.hpp"
#include "services/slammot/implementations.hpp"
#include "services/slammot/job_text.hpp"

namespace slammot {
namespace {

using files::Error;

/// "max" gives nullopt; anything but a positive number gives an Error.
files::Result<std::optional<double>> parse_speed(const std::string& speed) {
  if (speed == "max") return std::optional<double>();
  double times = 0.0;
  const auto [end, fault] = std::from_chars(speed.data(), speed.data() + speed.size(), times);
  const bool is_number = fault == std::errc() && end == speed.data() + speed.size();
  if (!is_number || !std::isfinite(times) || times <= 0.0)
    return Error{"--speed " + speed + ": neither a number above 0 nor max"};
  return std::optional<double>(times);
}

std::optional<Error> find_fault_of_implementations(const JobOptions& options,
                                                   const ImplementationChoice& choice) {
  if (const auto fault = find_fault(choice)) return Error{*fault};
  if (!options.map.empty() && !localization_of(choice).can_continue_map)
    return Error{"--map: the localization '" + choice.localization +
                 "' cannot continue a stored map"};
  return std::nullopt;
}

std::optional<Error> find_fault_of_source(const JobOptions& options) {
  if (options.input.empty() && options.scenario.empty())
    return Error{"a drive is required: --input FILE or --scenario NAME"};
  if (!options.input.empty() && !options.scenario.empty())
    return Error{"--input and --scenario exclude each other: a drive is recorded or simulated"};
  if (options.seed && options.scenario.empty())
    return Error{"--seed belongs to --scenario: a recorded drive has none"};
  return options.scenario.empty() ? std::nullopt : simulator::find_fault_of_name(options.scenario);
}

/// A drive before the settings are known.
struct OpenedDrive {
  std::optional<files::CarmenLog> log;                 ///< Empty for a simulated drive.
  std::optional<simulation::ScenarioConfig> scenario;  ///< Empty for a recorded drive.
  files::LogPlan plan;
  files::ProfileChoice profile;
};

files::Result<OpenedDrive> open_drive(const JobOptions& options) {
  OpenedDrive drive;
  if (!options.scenario.empty()) {
    auto scenario = simulator::load_scenario(options.scenario, options.seed);
    if (!scenario) return scenario.error();
    auto plan = simulator::plan_of(*scenario, options.topics.scanners);
    if (!plan) return plan.error();
    drive.plan = std::move(*plan);
    drive.profile = {scenario->profile, "by the scenario"};
    drive.scenario = std::move(*scenario);
  } else {
    files::CarmenLogOptions log_options;
    log_options.topics = options.topics;
    log_options.is_as_live = options.is_as_live;
    auto log = files::CarmenLog::open(options.input, log_options);
    if (!log) return log.error();
    drive.plan = log->plan();
    drive.profile = files::choose_profile(drive.plan.figures);
    drive.log = std::move(*log);
  }
  if (!options.profile.empty()) drive.profile = {options.profile, "as requested"};
  return drive;
}

files::CarmenLog begin(OpenedDrive& drive, const JobOptions& options,
                       const files::CarmenLogOptions& log_options) {
  if (drive.scenario) {
    auto lines = std::make_unique<simulator::LiveDrive>(*drive.scenario, options.output / "truth");
    return files::CarmenLog::follow(std::move(lines), drive.plan, log_options);
  }
  drive.log->set_options(log_options);
  return std::move(*drive.log);
}

/// About as much as the results take [bytes]: tables by scan and beam, twenty tracks a scan, maps
/// and report; of a simulated drive its log and truth, too.
std::uint64_t bytes_of_results(const files::LogFigures& figures, bool is_simulated) {
  constexpr std::uint64_t kOfTracks = 20 * 600;
  constexpr std::uint64_t kOfPoses = 400;
  constexpr std::uint64_t kOfMaps = 30'000'000;
  const std::uint64_t a_scan =
      kOfTracks + kOfPoses + 2 * figures.beams + (is_simulated ? 4 * figures.beams + 2000 : 0);
  return kOfMaps + figures.scans * a_scan;
}

/// Sets the initial odometry scale from the log's scan pairs. A scale in the profile has priority.
void set_initial_odometry_scale(double factor, localization::LocalizerConfig& config) {
  if (factor == 1.0 || config.belief.way_at_start != 1.0) return;
  config.belief.way_at_start = factor;
}

}  // namespace

void add_job_options(CLI::App& command, JobOptions& options) {
  command
      .add_option("--input,log", options.input,
                  "Recorded drive: a CARMEN or DP-SLAM log, plain or .gz, or a ROS bag (.bag, "
                  ".mcap, .db3, or the folder)")
      ->type_name("FILE");
  ingest::add_topic_options(command, options.topics);
  command
      .add_option("--scenario", options.scenario,
                  "Simulated drive instead of a recorded one; slammot simulate --list names them")
      ->type_name("NAME");
  command
      .add_option("--seed", options.seed,
                  "Seed of world, traffic and noise; default: the scenario's own")
      ->check(files::not_negative_number())
      ->type_name("N");
  command.add_option("--output", options.output, "Folder for the results; created if missing")
      ->required()
      ->type_name("DIR");
  command
      .add_option(
          "--profile", options.profile,
          "urban, indoor, another profile's name, or a file; default: by the drive's own figures")
      ->type_name("NAME");
  command.add_option("--config", options.config, "Settings that override the profile's")
      ->type_name("FILE");
  command.add_option("--speed", options.speed, "Multiple of the recorded rate, or max")
      ->type_name("X|max")
      ->capture_default_str();
  command
      .add_option("--map", options.map,
                  "Stored map in which to continue: a folder written with --store-map, map_store's "
                  "folder or its file")
      ->type_name("DIR|FILE");
  command.add_flag("--store-map", options.stores_map,
                   "Write the submaps to map.sqlite in the results, for --map");
  command.add_flag("--no-report", options.skips_report,
                   "Do not write report.html, in which the drive can be played");
  command.add_flag("--quiet", options.is_quiet, "Print warnings and faults only");
}

std::optional<Error> find_usage_fault(const JobOptions& options) {
  if (const auto speed = parse_speed(options.speed); !speed) return speed.error();
  if (!options.profile.empty() && !config::find_profile(options.profile))
    return Error{config::unknown_profile(options.profile)};
  return find_fault_of_source(options);
}

files::Result<Job> prepare_job(const JobOptions& options) {
  const auto speed = parse_speed(options.speed);
  if (!speed) return speed.error();
  auto drive = open_drive(options);
  if (!drive) return drive.error();
  Profile profile;
  if (auto fault = load_settings(drive->profile.profile, options.config, profile))
    return Error{std::move(*fault)};
  if (auto fault = find_fault_of_implementations(options, profile.implementations)) return *fault;
  profile.localization.odometry.time_is_known =
      profile.localization.odometry.time_is_known && drive->plan.figures.has_clock;
  // The sweep of a reversed scanner may run either way: the scale of the sweep is estimated.
  if (drive->plan.evidence.correction.reverses_beams)
    profile.localization.echoes.sweep_factor_sigma =
        std::max(profile.localization.echoes.sweep_factor_sigma, 1.0);
  profile.localization.odometry.watches_lateness = options.is_as_live;
  profile.localization.odometry.watches_factors = options.is_as_live;
  if (!options.is_as_live) {
    set_initial_odometry_scale(files::way_factor_of(drive->plan), profile.localization);
    profile.localization.belief.enabled = files::scans_show_motion(drive->plan);
  }
  const double sweep_s = files::sweep_s_for(drive->plan.figures, profile.ingest.sweep_s);
  if (auto fault = files::prepare_output_folder(options.output)) return *fault;
  if (auto fault = files::find_lack_of_space(
          options.output, bytes_of_results(drive->plan.figures, drive->scenario.has_value())))
    return *fault;
  return Job{begin(*drive, options, ingest::log_options(profile.ingest)),
             std::move(profile),
             drive->profile.profile,
             drive->profile.reason,
             sweep_s,
             *speed};
}

std::optional<Error> write_settings(const Profile& profile, const std::filesystem::path& folder) {
  Profile settings = profile;
  return files::write_file_atomically(folder / kSettingsFile, config::print(bind_stages(settings)));
}

std::vector<std::int64_t> stamps_of(files::CarmenLog& log) {
  std::vector<std::int64_t> stamps_ns;
  while (const auto event = log.next()) {
    if (const auto* scan = std::get_if<sensing::LaserScan>(&*event))
      stamps_ns.push_back(scan->stamp_ns);
  }
  return stamps_ns;
}

files::RunReport report_of(const Job& job, const JobOptions& options, const std::string& command) {
  files::RunReport report;
  report.command = command;
  report.version = SLAMMOT_VERSION;
  report.input = name_of_drive(options);
  report.profile = job.profile_name;
  report.profile_reason = job.profile_reason;
  report.sweep_s = job.sweep_s;
  report.plan = job.log.plan();
  report.faults = job.log.faults();
  report.gyro = job.log.gyro_use();
  report.replaced_stages = replaced_stages(job.profile.implementations);
  return report;
}

void write_report(const JobOptions& options, const files::RunRecord& record) {
  const std::filesystem::path page = options.output / evaluator::kReportFile;
  if (options.skips_report) {
    std::error_code ignored;
    std::filesystem::remove(page, ignored);  // That of an earlier run would be mistaken for this.
    return;
  }
  if (const auto fault = evaluator::write_report_of(record, options.output))
    std::fprintf(stderr, "warning:  no report: %s\n", fault->message.c_str());
}

void print(const JobOptions& options, const std::string& text) {
  if (!options.is_quiet) {
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
    return;
  }
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("warning:")) std::fprintf(stderr, "%s\n", line.c_str());
}

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;  // Linux reports kilobytes.
}

}  // namespace slammot
