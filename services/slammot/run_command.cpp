#include "services/slammot/run_command.hpp"

#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

#include <CLI/CLI.hpp>

#include "common/files/run_outputs.hpp"
#include "services/slammot/command_line.hpp"
#include "services/slammot/job.hpp"
#include "services/slammot/pipeline.hpp"
#include "services/slammot/progress_bar.hpp"

namespace slammot {
namespace {

using Clock = std::chrono::steady_clock;

int fail(const files::Error& fault) {
  std::fprintf(stderr, "slammot: %s\n", fault.message.c_str());
  return kExitFault;
}

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Holds the drive back to a multiple of the recorded rate, if one was asked for.
class Pace {
 public:
  Pace(std::optional<double> speed, std::int64_t first_stamp_ns) : speed_(speed), first_stamp_ns_(first_stamp_ns) {}

  void wait_for(std::int64_t stamp_ns) const {
    if (!speed_) return;
    const std::chrono::duration<double> due_after(static_cast<double>(stamp_ns - first_stamp_ns_) * 1e-9 / *speed_);
    std::this_thread::sleep_until(start_ + std::chrono::duration_cast<Clock::duration>(due_after));
  }

 private:
  std::optional<double> speed_;
  std::int64_t first_stamp_ns_;
  Clock::time_point start_ = Clock::now();
};

void drive(Job& job, Pipeline& pipeline) {
  ProgressBar progress("slammot run");
  std::optional<Pace> pace;
  while (auto event = job.log.next()) {
    if (const auto* odometry = std::get_if<sensing::Odometry>(&*event)) pipeline.take(*odometry);
    if (auto* scan = std::get_if<sensing::LaserScan>(&*event)) {
      scan->scanner.sweep_s = job.sweep_s;
      if (!pace) pace.emplace(job.speed, scan->stamp_ns);
      pace->wait_for(scan->stamp_ns);
      pipeline.take(*scan);
      progress.show(job.log.fraction_read());
    }
  }
  pipeline.finish();
}

int run(const JobOptions& options) {
  const auto start = Clock::now();
  auto job = prepare_job(options);
  if (!job) return fail(job.error());
  std::fputs(describe_job(*job, options).c_str(), stdout);
  std::fflush(stdout);
  Pipeline pipeline(job->profile);
  drive(*job, pipeline);
  files::RunReport report = report_of(*job, options, "run");
  report.counters = pipeline.counters();
  const double wall_s = seconds_since(start);
  report.measured = {pipeline.times().summary(), wall_s, report.plan.figures.duration_s / wall_s, peak_memory_mb()};
  if (const auto fault = files::write_outputs(options.output, pipeline.record(), report)) return fail(*fault);
  std::fputs(describe_outcome(pipeline.record(), report, options.output).c_str(), stdout);
  if (!report.faults.is_cut) return kExitDone;
  std::fflush(stdout);
  std::fprintf(stderr, "slammot: %s is cut off or damaged: only what could be read of it was processed\n", options.input.c_str());
  return kExitLogIsCut;
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand("run", "Take a drive, recorded or simulated, through all stages in this one process");
  const auto options = std::make_shared<JobOptions>();
  add_job_options(*command, *options);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace slammot
