#include "services/slammot/replay_command.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <memory>
#include <set>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "common/app/stop_signal.hpp"
#include "common/dds/config.hpp"
#include "common/dds/exit_watchdog.hpp"
#include "common/files/failure.hpp"
#include "services/slammot/command_line.hpp"
#include "services/slammot/replay_recording.hpp"
#include "services/slammot/replay_text.hpp"
#include "services/slammot/service_processes.hpp"
#include "services/slammot/service_replay.hpp"

namespace slammot {
namespace {

using namespace std::chrono_literals;

enum ReplayExit : int { kSame = 0, kDifferent = 1, kNotReplayed = 2 };

constexpr auto kStartTime = 20s;

struct ReplayOptions {
  std::string file;
  std::string service;
  std::filesystem::path binary;
  std::string vehicle_id;
  std::string profile;
  std::vector<std::string> config_files;
  std::vector<std::string> arguments;
  std::string speed = "max";
  std::vector<std::string> tolerances;
  std::uint32_t domain_id = 0;
};

int cannot_replay(std::string_view why) {
  files::fail(why);
  return kNotReplayed;
}

/// "1e-6" for all fields, "existence=0.01" for one.
std::optional<ReplayTolerances> tolerances_of(const std::vector<std::string>& texts) {
  ReplayTolerances tolerances;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    const std::string number = equals == std::string::npos ? text : text.substr(equals + 1);
    char* end = nullptr;
    const double value = std::strtod(number.c_str(), &end);
    if (number.empty() || *end != '\0' || !(value >= 0.0)) return std::nullopt;
    if (equals == std::string::npos) tolerances.general = value;
    else tolerances.of_field[text.substr(0, equals)] = value;
  }
  return tolerances;
}

void append_all(const std::string& option, const std::vector<std::string>& values,
                std::vector<std::string>& arguments) {
  for (const std::string& value : values) arguments.insert(arguments.end(), {option, value});
}

ServiceProcess process_of(const ReplayOptions& options, const ReplaySource& source,
                          const std::filesystem::path& folder) {
  std::string dashed = source.plan.service;
  std::ranges::replace(dashed, '_', '-');
  const auto program = options.binary.empty() ? folder_of_this_program() / ("slammot-" + dashed)
                                              : std::filesystem::absolute(options.binary);
  ServiceProcess process{source.plan.service,
                         {program, "--vehicle", source.vehicle_id, "--domain",
                          std::to_string(options.domain_id), "--state-dir", folder / "state"}};
  const bool is_set = !options.profile.empty() || !options.config_files.empty();
  if (!options.profile.empty()) append_all("--profile", {options.profile}, process.arguments);
  append_all("--config", options.config_files, process.arguments);
  if (!is_set) {
    for (const auto& path : extract_settings(source.file, folder))
      append_all("--config", {path}, process.arguments);
  }
  if (source.plan.service == "localization")
    append_all("--drive-id", drive_ids(source.file, source.vehicle_id), process.arguments);
  process.arguments.insert(process.arguments.end(), options.arguments.begin(),
                           options.arguments.end());
  return process;
}

int outcome(const ServiceReplay& replay, const ReplayComparison& comparison,
            ServiceReplay::End end) {
  std::printf("%llu samples given\n%s", static_cast<unsigned long long>(replay.inputs()),
              describe(comparison).c_str());
  if (end == ServiceReplay::End::kSilent)
    std::printf("ended early: the service does not answer any more\n");
  if (comparison.topics().empty())
    return cannot_replay("the recording has no output of the service");
  return comparison.has_difference() ? kDifferent : kSame;
}

int replay(const ReplayOptions& options, const ReplaySource& source, app::Pace pace,
           const ReplayTolerances& tolerances) {
  std::atomic<bool> is_interrupted = false;
  dds::ExitWatchdog watchdog;
  const app::StopSignal stop_signal([&] { is_interrupted = true; });
  const TemporaryFolder folder("slammot-replay-");
  const std::string bus = "slammot-replay-" + std::to_string(getpid());
  const dds::Participant participant(
      {options.domain_id, "slammot-replay", dds::loopback_config(bus)});
  ReplayComparison comparison(tolerances);
  ServiceReplay replay(participant, source, comparison);
  ServiceProcesses process({process_of(options, source, folder.path())}, folder.path(),
                           environment_of_bus(bus));
  std::optional<std::string> fault;
  const auto is_stopped = [&] {
    fault = process.find_end(source.plan.service);
    return is_interrupted || fault.has_value();
  };
  if (!replay.wait_for_service(kStartTime)) {
    is_stopped();
    return cannot_replay(fault.value_or(source.plan.service + " does not read its inputs"));
  }
  const auto end = replay.run(pace, is_stopped);
  if (fault) return cannot_replay(*fault);
  if (end == ServiceReplay::End::kStopped) return kExitInterrupted;
  watchdog.arm();
  return outcome(replay, comparison, end);
}

int replay(ReplayOptions options) {
  const auto plan = replay_plan(options.service);
  if (!plan)
    return cannot_replay("--service is one of " + replayed_services() + ", not " + options.service);
  const auto pace = app::Pace::parse(options.speed);
  if (!pace)
    return cannot_replay("--speed is max or a number from 0.01 to 1000, not " + options.speed);
  const auto tolerances = tolerances_of(options.tolerances);
  if (!tolerances) return cannot_replay("--tolerance is a number, or FIELD=NUMBER");
  const auto file = mcap::File::open(options.file);
  if (!file) return cannot_replay(file.error().message);
  const std::set<std::string> vehicles = vehicles_in(*file, *plan);
  if (vehicles.empty()) return cannot_replay(options.file + ": no " + plan->trigger + " in it");
  if (options.vehicle_id.empty() && vehicles.size() > 1)
    return cannot_replay(options.file + ": several vehicles: choose one by --vehicle");
  if (options.vehicle_id.empty()) options.vehicle_id = *vehicles.begin();
  return replay(options, {*file, *plan, options.vehicle_id}, *pace, *tolerances);
}

int replay_or_fail(const ReplayOptions& options) {
  try {
    return replay(options);
  } catch (const std::runtime_error& fault) { return cannot_replay(fault.what()); }
}

void add_settings(CLI::App& command, ReplayOptions& options) {
  command.add_option("--profile", options.profile,
                     "Profile of the service; without --profile and --config the settings in the "
                     "recording");
  command.add_option("--config", options.config_files, "Files of settings, the last one wins")
      ->type_name("FILE");
  command
      .add_option("--argument", options.arguments,
                  "Further arguments of the service, such as --argument=--continue-map")
      ->type_name("TEXT");
}

}  // namespace

void add_replay_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "replay",
      "Give a service what it received in a recording, and compare what it publishes with what was "
      "recorded: exit code 0 if it is the same, 1 if not");
  const auto options = std::make_shared<ReplayOptions>();
  command->add_option("file", options->file, "Recording")->required()->type_name("FILE");
  command->add_option("--service", options->service, "One of " + replayed_services())
      ->required()
      ->type_name("NAME");
  command->add_option("--binary", options->binary, "Program of the service; default: of this build")
      ->type_name("PATH")
      ->check(CLI::ExistingFile);
  command->add_option("--vehicle", options->vehicle_id, "Where the recording has several");
  add_settings(*command, *options);
  command
      ->add_option("--tolerance", options->tolerances,
                   "Of floating-point values, relative where they exceed 1; default 1e-9. "
                   "FIELD=NUMBER: of one field, such as existence=0.01")
      ->type_name("NUMBER,...")
      ->delimiter(',');
  command
      ->add_option("--speed", options->speed,
                   "Multiple of the recorded speed; max: as soon as the service has answered")
      ->capture_default_str();
  command
      ->add_option("--domain", options->domain_id,
                   "DDS domain, on loopback and isolated from others")
      ->check(CLI::Range(0, 230))
      ->capture_default_str();
  command->callback([options, &exit_code] { exit_code = replay_or_fail(*options); });
}

}  // namespace slammot
