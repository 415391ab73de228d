#include "services/slammot/run_command.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <memory>
#include <mutex>
#include <stop_token>

#include <CLI/CLI.hpp>

#include "common/app/stop_signal.hpp"
#include "common/files/failure.hpp"
#include "common/files/log_findings.hpp"
#include "common/files/run_outputs.hpp"
#include "common/files/text.hpp"
#include "services/slammot/command_line.hpp"
#include "services/slammot/job.hpp"
#include "services/slammot/job_text.hpp"
#include "services/slammot/lost_watch.hpp"
#include "services/slammot/pipeline.hpp"
#include "services/slammot/progress_bar.hpp"
#include "services/slammot/read_ahead.hpp"
#include "services/slammot/stored_map.hpp"
#include "services/slammot/street_search.hpp"

namespace slammot {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kMaxIterations = 10;  // Matching converges long before.

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Limits processing to a multiple of the recorded rate, if one is given.
class Pace {
 public:
  Pace(std::optional<double> speed, std::int64_t first_stamp_ns)
      : speed_(speed), first_stamp_ns_(first_stamp_ns) {}

  /// Waits until the scan is due or a stop is requested.
  void wait_for(std::int64_t stamp_ns, const std::stop_token& stop) const {
    if (!speed_) return;
    const std::chrono::duration<double> due_after(static_cast<double>(stamp_ns - first_stamp_ns_) *
                                                  1e-9 / *speed_);
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any().wait_until(
        lock, stop, start_ + std::chrono::duration_cast<Clock::duration>(due_after),
        [] { return false; });
  }

 private:
  std::optional<double> speed_;
  std::int64_t first_stamp_ns_;
  Clock::time_point start_ = Clock::now();
};

/// Options of `run` in addition to those of any job.
struct RunOptions {
  JobOptions job;
  int iterations = 1;  ///< Greatest number of matches of a scan.
  StreetOptions streets;
};

/// The processed part of a drive.
struct Driven {
  double duration_s = 0.0;
  bool is_interrupted = false;  ///< True if more of the drive remained.
  std::vector<files::LossOfPlace> losses{};
  std::optional<double> located_at_s{};  ///< In a stored map.
};

/// What happened so far, for the progress line.
class Progress {
 public:
  explicit Progress(const JobOptions& options)
      : bar_("slammot run", options.is_quiet ? Verbosity::kQuiet : Verbosity::kNormal) {}

  void update(const Pipeline& pipeline, double fraction, double driven_s) {
    const files::RunRecord& record = pipeline.record();
    if (const auto pose = record.last_pose()) {
      const double step_m = last_ ? (pose->translation_m() - last_->translation_m()).norm() : 0.0;
      if (!last_ || step_m > kCountedStepM) last_ = pose;
      if (step_m > kCountedStepM) distance_m_ += step_m;
    }
    if (!bar_.is_due()) return;
    bar_.show(fraction, driven_s,
              files::text("%llu scans, %.2f km, %zu tracks, %zu closures",
                          static_cast<unsigned long long>(record.scans()), 1e-3 * distance_m_,
                          record.tracks_now(), pipeline.accepted_closures()));
  }
  void say(const std::string& line) { bar_.say(line); }

 private:
  static constexpr double kCountedStepM = 0.5;  ///< Less is noise of a standing vehicle.

  ProgressBar bar_;
  std::optional<geometry::Pose2> last_;
  double distance_m_ = 0.0;
};

/// True if a submap of this drive is joined to the stored ones.
bool is_located(const Pipeline& pipeline, std::size_t stored) {
  return pipeline.record().submaps().size() > stored && pipeline.is_connected();
}

/// Processes the drive to its end or until a stop is requested.
Driven drive(Job& job, const JobOptions& options, Pipeline& pipeline, const std::stop_token& stop) {
  Progress progress(options);
  std::optional<Pace> pace;
  std::int64_t first_stamp_ns = 0;
  std::int64_t last_stamp_ns = 0;
  LostWatch lost(files::likely_causes(job.log.plan()));
  std::optional<double> located_at_s;
  const std::size_t stored = pipeline.record().submaps().size();
  ReadAhead log(job.log);
  auto read = log.next();
  for (; read && !stop.stop_requested(); read = log.next()) {
    if (const auto* odometry = std::get_if<sensing::Odometry>(&read->event))
      pipeline.take(*odometry);
    if (const auto* fix = std::get_if<sensing::GnssFix>(&read->event)) pipeline.take(*fix);
    if (const auto* reading = std::get_if<sensing::CompassReading>(&read->event))
      pipeline.take(*reading);
    if (auto* scan = std::get_if<sensing::LaserScan>(&read->event)) {
      scan->scanner.sweep_s = job.sweep_s;
      if (!pace) {
        pace.emplace(job.speed, scan->stamp_ns);
        first_stamp_ns = last_stamp_ns = scan->stamp_ns;
      }
      pace->wait_for(scan->stamp_ns, stop);
      pipeline.take(*scan);
      last_stamp_ns = std::max(last_stamp_ns, scan->stamp_ns);
      const double driven_s = static_cast<double>(scan->stamp_ns - first_stamp_ns) * 1e-9;
      if (const auto line =
              lost.update(driven_s, scan->sequence, pipeline.is_lost(), pipeline.maps_begun()))
        progress.say(*line);
      if (!located_at_s && is_located(pipeline, stored)) located_at_s = driven_s;
      progress.update(pipeline, read->fraction_read, driven_s);
    }
  }
  pipeline.finish();
  return {static_cast<double>(last_stamp_ns - first_stamp_ns) * 1e-9, read.has_value(),
          lost.losses(), located_at_s};
}

/// Prints the last line of an incomplete run and returns its exit code.
int report_end(const JobOptions& options, const files::RunReport& report, const Driven& driven) {
  std::fflush(stdout);
  if (driven.is_interrupted) {
    std::fprintf(stderr,
                 "slammot: interrupted: only the first %.1f s of the drive were processed\n",
                 driven.duration_s);
    return kExitInterrupted;
  }
  return report_damage(options.input, report.faults);
}

/// Continues the stored map, if one is given.
std::optional<files::Error> continue_stored_map(const JobOptions& options, const Profile& profile,
                                                Pipeline& pipeline) {
  if (options.map.empty()) return std::nullopt;
  const auto stored = read_stored_map(options.map, profile.localization.map.cell_size_m);
  if (!stored) return stored.error();
  pipeline.continue_map(*stored);
  print(options, files::text("map:      %zu submaps of %s\n", stored->size(), options.map.c_str()));
  return std::nullopt;
}

/// Relation of the drive to the map, if it was lost or began in a stored map.
std::string describe_location(const Pipeline& pipeline, const RunOptions& options,
                              std::optional<double> located_at_s) {
  const auto after = [](std::optional<double> time_s) {
    return time_s ? files::text(" after %.1f s", *time_s) : std::string();
  };
  const auto maps_begun = pipeline.maps_begun();
  if (options.job.map.empty() && maps_begun == 0) return {};
  const auto found = pipeline.counters().at("loop_closing").at("found_elsewhere");
  const std::string lost =
      maps_begun == 0 ? std::string()
                      : "warning:  localization was lost and began a new part of the map, " +
                            std::to_string(maps_begun) + " times\n";
  const std::string place =
      pipeline.is_connected()
          ? "the drive is located in the map" + after(located_at_s) +
                " (parts joined: " + std::to_string(found) + ")\n"
          : "the drive is not located in the map: the origin of its poses is arbitrary\n";
  return lost + (pipeline.is_connected() ? "map:      " : "warning:  ") + place;
}

/// Writes the map with what moved in it, in this drive and in earlier ones, if that is wanted.
std::optional<files::Error> store_map(const JobOptions& options, const Pipeline& pipeline) {
  if (!options.stores_map) return std::nullopt;
  files::Result<traffic::SubmapTraffic> earlier = traffic::SubmapTraffic();
  if (!options.map.empty()) earlier = read_stored_traffic(options.map);  // may be replaced below
  if (!earlier) return earlier.error();
  if (auto fault = write_stored_map(options.output, pipeline.record().submaps())) return fault;
  if (auto fault = write_stored_traffic(options.output, *earlier)) return fault;
  return write_stored_traffic(options.output, pipeline.traffic());
}

int run(const RunOptions& run_options) {
  const JobOptions& options = run_options.job;
  if (const auto fault = find_usage_fault(options)) return files::refuse(fault->message);
  const auto start = Clock::now();
  std::stop_source interruption;
  const app::StopSignal stop_signal([&] { interruption.request_stop(); });
  const auto streets = prepare_streets(run_options.streets);
  if (!streets) return files::fail(streets.error());
  auto job = prepare_job(options);
  if (!job) return files::fail(job.error());
  print(options, describe_job(*job, options));
  Pipeline pipeline(job->profile, run_options.iterations);
  if (const auto fault = continue_stored_map(options, job->profile, pipeline))
    return files::fail(*fault);
  const Driven driven = drive(*job, options, pipeline, interruption.get_token());
  if (driven.is_interrupted && pipeline.record().scans() == 0) {
    std::fprintf(stderr, "slammot: interrupted before the first scan: nothing was written\n");
    return kExitInterrupted;
  }
  files::RunReport report = report_of(*job, options, "run");
  report.counters = pipeline.counters();
  report.odometry = pipeline.verdict_on_odometry();
  report.losses = driven.losses;
  report.is_in_stored_map = !options.map.empty();
  report.located_at_s = driven.located_at_s;
  report.is_interrupted = driven.is_interrupted;
  if (*streets) {
    const files::MapImage map = map_of(pipeline.record());
    report.streets = find_on_streets(**streets, pipeline.record().corrected_trajectory(),
                                     pipeline.record().georeference(), &map);
  }
  const double wall_s = seconds_since(start);
  report.measured = {pipeline.times().summary(), wall_s, driven.duration_s / wall_s,
                     peak_memory_mb()};
  if (const auto fault = files::write_outputs(options.output, pipeline.record(), report))
    return files::fail(*fault);
  if (const auto fault = write_settings(job->profile, options.output)) return files::fail(*fault);
  if (const auto fault = store_map(options, pipeline)) return files::fail(*fault);
  write_report(options, pipeline.record());
  print(options, describe_location(pipeline, run_options, driven.located_at_s));
  print(options, describe_outcome(pipeline.record(), report, options.output));
  print(options, describe_leftovers(options));
  return report_end(options, report, driven);
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand("run", "Process a recorded or simulated drive in this one process");
  const auto options = std::make_shared<RunOptions>();
  add_job_options(*command, options->job);
  command
      ->add_option("--iterations", options->iterations,
                   "Maximum number of matches of a scan, each without what detection then labelled "
                   "as moving")
      ->type_name("N")
      ->check(CLI::Range(1, kMaxIterations))
      ->capture_default_str();
  command->add_flag(
      "--as-live", options->job.is_as_live,
      "Take the log as live sensors publish it: nothing is corrected before the drive");
  add_street_options(*command, options->streets);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace slammot
