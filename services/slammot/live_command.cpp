#include "services/slammot/live_command.hpp"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <thread>
#include <utility>

#include <CLI/CLI.hpp>

#include "common/app/bus_option.hpp"
#include "common/app/service_options.hpp"
#include "common/app/stop_signal.hpp"
#include "common/dds/config.hpp"
#include "common/dds/participant.hpp"
#include "common/dds/reader.hpp"
#include "common/files/failure.hpp"
#include "common/wire/service.hpp"
#include "services/simulator/scenario_files.hpp"
#include "services/slammot/command_line.hpp"
#include "services/slammot/service_processes.hpp"

namespace slammot {
namespace {

using namespace std::chrono_literals;

struct LiveOptions {
  std::string scenario = "demo";
  std::string speed = "1";
  std::uint16_t port = 8765;
  std::uint32_t domain_id = 0;
  std::string bus = "slammot-live-" + std::to_string(getpid());
};

/// The simulator comes last, so that the others receive the first scans.
std::vector<ServiceProcess> services_for(const LiveOptions& options, const std::string& profile,
                                         const std::filesystem::path& state_folder) {
  std::vector<ServiceProcess> services;
  for (const std::string name : {"gateway", "map-store", "loop-closing", "localization",
                                 "detection", "tracking", "simulator"}) {
    std::vector<std::string> arguments = {folder_of_this_program() / ("slammot-" + name),
                                          "--domain", std::to_string(options.domain_id),
                                          "--state-dir", state_folder};
    if (name == "gateway") {
      arguments.insert(arguments.end(), {"--port", std::to_string(options.port)});
    } else if (name == "simulator") {
      arguments.insert(arguments.end(),
                       {"--scenario", options.scenario, "--speed", options.speed, "--linger"});
    } else if (!profile.empty()) {
      arguments.insert(arguments.end(), {"--profile", profile});
    }
    services.push_back({name, std::move(arguments)});
  }
  return services;
}

/// Hears from the simulator that its drive has ended.
class DriveWatch {
 public:
  explicit DriveWatch(const LiveOptions& options)
      : participant_({options.domain_id, "slammot-live", dds::loopback_config(options.bus)}),
        statuses_(participant_, dds::topics::kStatus) {}

  /// True once, after the end.
  bool take_end() {
    const bool had_ended = has_ended_;
    statuses_.take_each([this](const slammot_ServiceStatus& sample) {
      const auto status = wire::decode(sample);
      if (!status || status->name.service != "simulator") return;
      for (const wire::Counter& counter : status->counters)
        if (counter.name == "log_finished") has_ended_ = counter.total > 0;
    });
    return has_ended_ && !had_ended;
  }

 private:
  dds::Participant participant_;
  dds::Reader<slammot_ServiceStatus> statuses_;
  bool has_ended_ = false;
};

/// Keeps the services running until a signal, and says what happens to them.
int watch(ServiceProcesses& services, DriveWatch& drive, const std::atomic<bool>& is_interrupted) {
  auto restarts = services.restarts();
  while (!is_interrupted) {
    if (const auto fault = services.restart_dead()) return files::fail(*fault);
    for (const auto& [name, count] : services.restarts()) {
      if (std::exchange(restarts[name], count) == count) continue;
      std::fprintf(stderr, "slammot: %s ended unexpectedly and was started again\n", name.c_str());
    }
    if (drive.take_end()) {
      std::printf("the drive has ended; the view stays until Ctrl-C\n");
      std::fflush(stdout);
    }
    std::this_thread::sleep_for(50ms);
  }
  return kExitDone;
}

int live(const LiveOptions& options) {
  if (const auto fault = simulator::find_fault_of_name(options.scenario))
    return files::refuse(fault->message);
  std::atomic<bool> is_interrupted = false;
  const app::StopSignal stop_signal([&] { is_interrupted = true; });
  const auto scenario = simulator::load_scenario(options.scenario, std::nullopt);
  if (!scenario) return files::fail(scenario.error().message);
  const TemporaryFolder folder("slammot-live-");
  ServiceProcesses services(services_for(options, scenario->profile, folder.path()), folder.path(),
                            environment_of_bus(options.bus));
  std::printf("live view: http://localhost:%d/  (Ctrl-C ends it)\n", int{options.port});
  std::printf("its services: slammot top --bus %s\n", options.bus.c_str());
  std::fflush(stdout);
  DriveWatch drive(options);
  return watch(services, drive, is_interrupted);
}

int live_or_fail(const LiveOptions& options) {
  try {
    return live(options);
  } catch (const std::runtime_error& fault) { return files::fail(fault.what()); }
}

}  // namespace

void add_live_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "live", "Show a simulated drive in the browser while the services process it");
  const auto options = std::make_shared<LiveOptions>();
  command->add_option("--scenario", options->scenario, "Name (slammot simulate --list) or file")
      ->capture_default_str();
  app::add_speed_option(*command, options->speed, "Multiple of the simulated clock, or max");
  command->add_option("--port", options->port, "Port of the live view")->capture_default_str();
  command
      ->add_option("--domain", options->domain_id,
                   "DDS domain, on loopback and isolated from others")
      ->envname("SLAMMOT_DOMAIN")
      ->check(CLI::Range(0, 230))
      ->capture_default_str();
  app::add_bus_option(*command, options->bus);
  command->callback([options, &exit_code] { exit_code = live_or_fail(*options); });
}

}  // namespace slammot
