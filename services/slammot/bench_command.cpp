#include "services/slammot/bench_command.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <iterator>
#include <memory>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "common/app/bus_option.hpp"
#include "common/app/stop_signal.hpp"
#include "common/dds/config.hpp"
#include "common/files/atomic_file.hpp"
#include "common/files/failure.hpp"
#include "common/files/run_outputs.hpp"
#include "common/files/text.hpp"
#include "services/ingest/topic_arguments.hpp"
#include "services/simulator/drive_files.hpp"
#include "services/simulator/scenario_files.hpp"
#include "services/slammot/collector.hpp"
#include "services/slammot/command_line.hpp"
#include "services/slammot/implementations.hpp"
#include "services/slammot/job.hpp"
#include "services/slammot/job_text.hpp"
#include "services/slammot/progress_bar.hpp"
#include "services/slammot/service_processes.hpp"
#include "services/slammot/stored_map.hpp"

namespace slammot {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kSubmapTimeout = 30s;
constexpr auto kInterruptedSubmapTimeout = 5s;
constexpr auto kFinalStatusTime = 50ms;
constexpr const char* kVehicle = "bench";
constexpr const char* kFound = "map:      the drive is located in the map\n";
constexpr const char* kNotFound =
    "warning:  the drive is not located in the map: the origin of its poses is arbitrary\n";

struct BenchOptions : JobOptions {
  std::uint32_t domain_id = 0;
  std::string bus = "slammot-bench-" + std::to_string(getpid());
};

/// Settings file for the services: the user's, or the complete settings of the job if the log
/// changed some of them.
files::Result<std::filesystem::path> settings_file(const Job& job, const BenchOptions& options,
                                                   const std::filesystem::path& folder) {
  const bool is_changed = !job.profile.localization.odometry.time_is_known ||
                          job.log.plan().evidence.correction.reverses_beams ||
                          job.profile.localization.belief.way_at_start != 1.0;
  if (!is_changed) return options.config;
  if (const auto fault = write_settings(job.profile, folder)) return *fault;
  return folder / kSettingsFile;
}

/// Program that implements a service.
std::string program_of(const std::string& service, const ImplementationChoice& choice) {
  if (service == "localization") return "slammot-" + std::string(localization_of(choice).program);
  if (service == "tracking") return "slammot-" + std::string(tracking_of(choice).program);
  return "slammot-" + service;
}

std::vector<ServiceProcess> services_for(const Job& job, const BenchOptions& options,
                                         const std::filesystem::path& settings,
                                         const std::filesystem::path& state_folder) {
  std::vector<ServiceProcess> services;
  for (const std::string name :
       {"map-store", "loop-closing", "localization", "detection", "tracking", "ingest"}) {
    std::vector<std::string> arguments = {
        folder_of_this_program() / program_of(name, job.profile.implementations),
        "--vehicle",
        kVehicle,
        "--domain",
        std::to_string(options.domain_id),
        "--state-dir",
        state_folder,
        "--profile",
        job.profile_name};
    if (!settings.empty()) arguments.insert(arguments.end(), {"--config", settings});
    if (name == "localization" && !options.map.empty()) arguments.push_back("--continue-map");
    if (arguments.front() == folder_of_this_program() / "slammot-localization")
      arguments.push_back("--examined-log");
    const bool is_ingest = name == "ingest";
    if (is_ingest) {
      arguments.insert(arguments.end(), {"--input", options.input, "--speed", options.speed});
      std::ranges::copy(ingest::arguments_of(options.topics), std::back_inserter(arguments));
    }
    services.push_back({name, std::move(arguments), is_ingest});
  }
  return services;
}

/// Writes the stored map with what moved in it, if there is one, to where map_store reads it.
std::optional<files::Error> provide_map(const Job& job, const BenchOptions& options,
                                        const std::filesystem::path& state_folder) {
  if (options.map.empty()) return std::nullopt;
  const auto stored = read_stored_map(options.map, job.profile.localization.map.cell_size_m);
  if (!stored) return stored.error();
  print(options, files::text("map:      %zu submaps of %s\n", stored->size(), options.map.c_str()));
  if (auto fault = write_stored_map(state_folder, *stored, kVehicle)) return fault;
  return copy_traffic(options.map, state_folder);
}

/// Waits until the drive has ended or is interrupted. Returns a message if a service keeps failing.
std::optional<std::string> await_drive(Collector& collector, ServiceProcesses& services,
                                       const std::vector<std::int64_t>& stamps_ns,
                                       const std::atomic<bool>& is_interrupted,
                                       Verbosity verbosity) {
  ProgressBar progress("slammot bench", verbosity);
  const double duration_ns =
      static_cast<double>(std::max<std::int64_t>(1, stamps_ns.back() - stamps_ns.front()));
  auto check_services_at = Clock::now();
  while (!collector.has_drive_ended() && !is_interrupted) {
    collector.wait(100ms);
    if (collector.last_localized_ns()) {
      const auto driven_ns =
          static_cast<double>(*collector.last_localized_ns() - stamps_ns.front());
      progress.show(driven_ns / duration_ns, driven_ns * 1e-9);
    }
    if (Clock::now() < check_services_at) continue;
    if (auto fault = services.restart_dead()) return fault;
    check_services_at = Clock::now() + 20ms;
  }
  return std::nullopt;
}

double peak_memory_of_services_mb() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);  // Of the largest process that has ended.
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

files::RunReport make_report(const Job& job, const BenchOptions& options,
                             const Collector& collector,
                             const std::map<std::string, std::uint64_t>& restarts) {
  files::RunReport report = report_of(job, options, "bench");
  report.counters = collector.counters();
  for (const auto& [name, count] : restarts)
    report.counters["bench"]["restarts_of_" + name] = count;
  return report;
}

int write(const Job& job, const BenchOptions& options, const files::RunRecord& record,
          const files::RunReport& report, double duration_s) {
  if (const auto fault = files::write_outputs(options.output, record, report))
    return files::fail(fault->message);
  if (const auto fault = write_settings(job.profile, options.output))
    return files::fail(fault->message);
  if (options.stores_map) {
    if (const auto fault = write_stored_map(options.output, record.submaps()))
      return files::fail(fault->message);
  }
  write_report(options, record);
  if (!options.map.empty()) print(options, record.is_connected() ? kFound : kNotFound);
  print(options, describe_outcome(record, report, options.output));
  for (const auto& [name, count] : report.counters.at("bench")) {
    if (count > 0) print(options, name + ": " + std::to_string(count) + "\n");
  }
  if (report.is_interrupted) {
    std::fprintf(stderr,
                 "slammot: interrupted: only the first %.1f s of the drive were processed\n",
                 duration_s);
    return kExitInterrupted;
  }
  return report_damage(options.input, report.faults);
}

/// Services read recorded drives only: records a simulated drive as truth.log, with its ground
/// truth, in the output folder.
files::Result<BenchOptions> with_recorded_drive(BenchOptions options) {
  if (options.scenario.empty() || !options.input.empty()) return options;
  const auto scenario = simulator::load_scenario(options.scenario, options.seed);
  if (!scenario) return scenario.error();
  const auto written = simulator::write_drive(*scenario, options.output, {"truth", "truth"},
                                              simulator::HitsFile::written);
  if (!written.files) return files::Error{written.fault};
  options.input = written.files->log;
  if (options.profile.empty()) options.profile = scenario->profile;
  options.scenario.clear();
  options.seed.reset();
  return options;
}

void keep_until(std::int64_t last_ns, std::vector<std::int64_t>& stamps_ns) {
  std::erase_if(stamps_ns, [&](std::int64_t stamp_ns) { return stamp_ns > last_ns; });
}

double duration_of(const std::vector<std::int64_t>& stamps_ns) {
  return static_cast<double>(*std::ranges::max_element(stamps_ns) - stamps_ns.front()) * 1e-9;
}

int bench(const BenchOptions& requested) {
  if (const auto fault = find_usage_fault(requested)) return files::refuse(fault->message);
  std::atomic<bool> is_interrupted = false;
  const app::StopSignal stop_signal([&] { is_interrupted = true; });
  const auto recorded = with_recorded_drive(requested);
  if (!recorded) return files::fail(recorded.error().message);
  const BenchOptions& options = *recorded;
  const auto start = Clock::now();
  auto job = prepare_job(options);
  if (!job) return files::fail(job.error().message);
  print(options, describe_job(*job, options));
  std::vector<std::int64_t> stamps_ns = stamps_of(job->log);

  const TemporaryFolder folder("slammot-bench-");
  if (const auto fault = provide_map(*job, options, folder.path()))
    return files::fail(fault->message);
  const auto settings = settings_file(*job, options, folder.path());
  if (!settings) return files::fail(settings.error().message);
  Collector collector({kVehicle, options.domain_id, dds::loopback_config(options.bus)});
  std::optional<ServiceProcesses> services;
  services.emplace(services_for(*job, options, *settings, folder.path()), folder.path(),
                   environment_of_bus(options.bus));
  if (const auto fault = await_drive(collector, *services, stamps_ns, is_interrupted,
                                     options.is_quiet ? Verbosity::kQuiet : Verbosity::kNormal))
    return files::fail(*fault);
  const bool is_cut_short = is_interrupted && !collector.has_drive_ended();
  if (is_cut_short) services->end("ingest");
  if (is_cut_short && !collector.last_localized_ns()) {
    std::fprintf(stderr, "slammot: interrupted before the first scan: nothing was written\n");
    return kExitInterrupted;
  }
  const bool is_complete =
      collector.finish(is_cut_short ? kInterruptedSubmapTimeout : kSubmapTimeout);
  const auto restarts = services->restarts();
  services.reset();
  collector.wait(kFinalStatusTime);  // final counters of the services
  files::RunReport report = make_report(*job, options, collector, restarts);
  const double wall_s = std::chrono::duration<double>(Clock::now() - start).count();
  if (is_cut_short) keep_until(*collector.last_localized_ns(), stamps_ns);
  const double duration_s = duration_of(stamps_ns);
  report.is_interrupted = is_cut_short;
  report.measured = {collector.latencies(), wall_s, duration_s / wall_s,
                     std::max(peak_memory_mb(), peak_memory_of_services_mb())};
  const int exit_code = write(*job, options, collector.record(stamps_ns), report, duration_s);
  if (options.stores_map) {
    if (const auto fault = copy_traffic(folder.path(), options.output))
      return files::fail(fault->message);
  }
  if (!is_complete && !is_cut_short)
    return files::fail("the last submap did not arrive: the map lacks the end of the drive");
  return exit_code;
}

int bench_or_fail(const BenchOptions& options) {
  try {
    return bench(options);
  } catch (const std::runtime_error& fault) { return files::fail(fault.what()); }
}

}  // namespace

void add_bench_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "bench",
      "Process a recorded or simulated drive by the real services, over DDS on this machine");
  const auto options = std::make_shared<BenchOptions>();
  add_job_options(*command, *options);
  command
      ->add_option("--domain", options->domain_id,
                   "DDS domain, on loopback and isolated from others")
      ->envname("SLAMMOT_DOMAIN")
      ->check(CLI::Range(0, 230))
      ->capture_default_str();
  app::add_bus_option(*command, options->bus);
  command->callback([options, &exit_code] { exit_code = bench_or_fail(*options); });
}

}  // namespace slammot
