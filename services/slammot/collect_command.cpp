#include "services/slammot/collect_command.hpp"

#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>

#include <CLI/CLI.hpp>

#include "common/app/stop_signal.hpp"
#include "common/files/atomic_file.hpp"
#include "common/files/run_outputs.hpp"
#include "services/slammot/collector.hpp"
#include "services/slammot/command_line.hpp"
#include "services/slammot/job.hpp"

namespace slammot {
namespace {

using namespace std::chrono_literals;

struct CollectOptions : CollectorOptions {
  std::filesystem::path output;
};

int fail(const std::string& line) {
  std::fprintf(stderr, "slammot: %s\n", line.c_str());
  return kExitFault;
}

int collect(const CollectOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  std::atomic<Collector*> to_stop = nullptr;
  const app::StopSignal stop_signal([&] {
    if (Collector* collector = to_stop) collector->stop();
  });
  if (const auto fault = files::prepare_output_folder(options.output)) return fail(fault->message);
  Collector collector(options);
  to_stop = &collector;
  std::printf("waits for the drive of vehicle %s\n", options.vehicle_id.c_str());
  std::fflush(stdout);
  while (!collector.has_drive_ended() && collector.wait(100ms)) {
  }
  // Interrupted, what has come so far is written all the same.
  const bool is_complete = collector.finish(60s);
  to_stop = nullptr;
  const files::RunRecord record = collector.record(collector.scan_stamps_ns());
  files::RunReport report;
  report.command = "collect";
  report.version = SLAMMOT_VERSION;
  report.counters = collector.counters();
  report.measured.stages = collector.latencies();
  report.measured.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  report.measured.peak_memory_mb = peak_memory_mb();
  if (const auto fault = files::write_outputs(options.output, record, report)) return fail(fault->message);
  std::fputs(describe_outcome(record, report, options.output).c_str(), stdout);
  return is_complete ? kExitDone : fail("the last submap did not come: the map lacks the end of the drive");
}

}  // namespace

void add_collect_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand("collect", "Write what the services on the bus make of a drive, when it has ended");
  const auto options = std::make_shared<CollectOptions>();
  command->add_option("--output", options->output, "Folder for the results; made where it is missing")->required()->type_name("DIR");
  command->add_option("--vehicle", options->vehicle_id, "Whose drive")->capture_default_str();
  command->add_option("--domain", options->domain_id, "DDS domain")->check(CLI::Range(0, 230))->capture_default_str();
  command->callback([options, &exit_code] {
    try {
      exit_code = collect(*options);
    } catch (const std::runtime_error& fault) {
      exit_code = fail(fault.what());
    }
  });
}

}  // namespace slammot
