#include "services/slammot/collect_command.hpp"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include <CLI/CLI.hpp>

#include "common/app/service_options.hpp"
#include "common/app/stop_signal.hpp"
#include "common/files/atomic_file.hpp"
#include "common/files/failure.hpp"
#include "common/files/foreign_file.hpp"
#include "common/files/run_outputs.hpp"
#include "services/ingest/topic_arguments.hpp"
#include "services/slammot/collector.hpp"
#include "services/slammot/command_line.hpp"
#include "services/slammot/job.hpp"
#include "services/slammot/job_text.hpp"

namespace slammot {
namespace {

using namespace std::chrono_literals;

struct CollectOptions : CollectorOptions {
  std::filesystem::path output;
  std::filesystem::path input;  ///< The log that is played; may be empty.
  files::TopicOptions topics;   ///< Must equal those of the player.
};

/// A log that is missing is refused before the drive, although it is read after it.
std::optional<files::Error> find_fault_of_input(const std::filesystem::path& input) {
  if (input.empty() || std::filesystem::is_directory(input)) return std::nullopt;
  if (access(input.c_str(), R_OK) != 0)
    return files::Error{"--input " + input.string() + ": " + std::strerror(errno)};
  return files::find_foreign(input);
}

/// Stamps of all scans of the log. Also fills the report's description of it.
files::Result<std::vector<std::int64_t>> scans_of_log(const CollectOptions& options,
                                                      files::RunReport& report) {
  files::CarmenLogOptions log_options;
  log_options.topics = options.topics;
  log_options.uses_all_scanners = true;
  auto log = files::CarmenLog::open(options.input, log_options);
  if (!log) return log.error();
  std::vector<std::int64_t> stamps_ns = stamps_of(*log);
  report.input = options.input.filename().string();
  report.plan = log->plan();
  report.faults = log->faults();
  report.gyro = log->gyro_use();
  return stamps_ns;
}

int write(const CollectOptions& options, Collector& collector, double wall_s) {
  files::RunReport report;
  report.command = "collect";
  report.version = SLAMMOT_VERSION;
  report.counters = collector.counters();
  report.measured.stages = collector.latencies();
  report.measured.wall_s = wall_s;
  report.measured.peak_memory_mb = peak_memory_mb();
  files::Result<std::vector<std::int64_t>> of_log = collector.scan_stamps_ns();
  if (!options.input.empty()) of_log = scans_of_log(options, report);
  const files::RunRecord record = collector.record(of_log ? *of_log : collector.scan_stamps_ns());
  if (const auto fault = files::write_outputs(options.output, record, report))
    return files::fail(fault->message);
  if (!of_log)
    return files::fail(of_log.error().message + ": only scans that were received have rows in " +
                       options.output.string());
  collector.remove_journal();
  std::fputs(describe_outcome(record, report, options.output).c_str(), stdout);
  if (report.faults.is_cut)
    std::fprintf(stderr,
                 "slammot: the log is cut off or damaged: only the readable part was processed%s\n",
                 where_damaged(report.faults).c_str());
  return kExitDone;
}

int collect(const CollectOptions& options) {
  if (const auto fault = find_fault_of_input(options.input)) return files::fail(*fault);
  const auto start = std::chrono::steady_clock::now();
  std::atomic<Collector*> to_stop = nullptr;
  const app::StopSignal stop_signal([&] {
    if (Collector* collector = to_stop) collector->stop();
  });
  if (const auto fault = files::prepare_output_folder(options.output))
    return files::fail(fault->message);
  CollectorOptions with_journal = options;
  with_journal.journal = options.output / "collected.journal";
  Collector collector(with_journal);
  to_stop = &collector;
  std::printf("waits for the drive of vehicle %s\n", options.vehicle_id.c_str());
  std::fflush(stdout);
  while (!collector.has_drive_ended() && collector.wait(100ms)) {}
  // After an interruption, everything received so far is written.
  const bool is_complete = collector.finish(60s);
  to_stop = nullptr;
  const int exit_code =
      write(options, collector,
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  if (exit_code != kExitDone) return exit_code;
  return is_complete
             ? kExitDone
             : files::fail("the last submap did not arrive: the map lacks the end of the drive");
}

}  // namespace

void add_collect_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "collect",
      "Collect the outputs of services on the bus and write them when the drive has ended");
  const auto options = std::make_shared<CollectOptions>();
  command->add_option("--output", options->output, "Folder for the results; created if missing")
      ->required()
      ->type_name("DIR");
  command
      ->add_option("--input", options->input,
                   "The log that is played, for rows of scans that were not received")
      ->type_name("FILE");
  ingest::add_topic_options(*command, options->topics);
  command->add_option("--vehicle", options->vehicle_id, "Vehicle whose drive is collected")
      ->capture_default_str();
  app::add_domain_option(*command, options->domain_id);
  command->callback([options, &exit_code] {
    try {
      exit_code = collect(*options);
    } catch (const std::runtime_error& fault) { exit_code = files::fail(fault.what()); }
  });
}

}  // namespace slammot
