#include "common/app/run_service.hpp"

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>

#include <CLI/CLI.hpp>

#include "common/app/give_way.hpp"
#include "common/app/interface_watch.hpp"
#include "common/app/log.hpp"
#include "common/app/standby.hpp"
#include "common/app/state_lock.hpp"
#include "common/app/stop_signal.hpp"
#include "common/app/version.hpp"
#include "common/config/explain.hpp"
#include "common/config/print.hpp"
#include "common/dds/exit_watchdog.hpp"

namespace slammot::app {
namespace {

int refuse(const std::string& program, const std::string& why) {
  std::cerr << program << ": " << why << "\n";
  return kExitUsage;
}

/// --help and --version are no failures.
int answer(const CLI::App& command_line, const CLI::ParseError& fault) {
  if (fault.get_exit_code() == 0) return command_line.exit(fault);
  return refuse(command_line.get_name(), std::string(fault.what()) + " (see --help)");
}

/// The state is in use by another process.
class InUse : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

std::filesystem::path lock_path(const ServiceDescription& description,
                                const ServiceOptions& options) {
  const StateOf of = description.is_one_per_vehicle ? StateOf::kVehicle : StateOf::kInstance;
  return state_path(options, description.name, of, ".lock");
}

void refuse_if_in_use(StateLock& lock) {
  if (lock.try_lock() == StateLock::Outcome::kInUse) throw InUse(lock.reason());
}

/// Reports why there is no lock, and tries again: a full disk may be cleared.
void watch(StateLock& lock, ServiceContext& context) {
  context.status().set_trouble("state", lock.reason());
  context.every(std::chrono::seconds(1), [&] {
    if (lock.reason().empty()) return;
    if (lock.try_lock() == StateLock::Outcome::kLocked) context.status().clear_trouble("state");
    else context.status().set_trouble("state", lock.reason());
  });
}

/// Ends the process, which its supervisor starts again, when the interface of a bus between
/// computers was replaced. Without SLAMMOT_INTERFACE does nothing.
void watch_interface(ServiceContext& context) {
  const char* const name = std::getenv("SLAMMOT_INTERFACE");
  if (name == nullptr || *name == '\0') return;
  const auto watch =
      std::make_shared<InterfaceWatch>([name] { return identity_of_interface(name); });
  context.every(std::chrono::milliseconds(200), [&context, watch, name] {
    if (!watch->was_replaced()) return;
    log_error("ends: interface {} is back, and has to be joined anew", name);
    context.stop(kExitFailure);
  });
}

/// The service is destroyed before the context that it refers to, and both before the watchdog
/// stops.
int serve(const ServiceDescription& description, const ServiceOptions& options) {
  dds::ExitWatchdog watchdog;
  StateLock lock(lock_path(description, options));
  if (description.keeps_state && !description.is_one_per_vehicle) refuse_if_in_use(lock);
  ServiceContext context(description.name, options);
  const StopSignal stop_signal([&] {
    watchdog.arm();  // also guards against a handler that does not return
    context.request_stop();
  });
  watch_interface(context);
  std::optional<Standby> standby;
  if (description.is_one_per_vehicle) {
    standby.emplace(context, description.keeps_state ? &lock : nullptr);
    if (description.prepare) description.prepare(context);
    if (!standby->wait_until_it_leads(description.rehearse)) return context.exit_code();
  }
  if (!lock.reason().empty()) watch(lock, context);
  std::shared_ptr<void> service = description.make(context);
  log_info("vehicle {} in DDS domain {}", options.vehicle_id, options.domain_id);
  context.run([&] {
    service.reset();
    lock.release();
  });
  return context.exit_code();
}

int serve_or_say_why_not(const std::string& program, const ServiceDescription& description,
                         const ServiceOptions& options) {
  try {
    return serve(description, options);
  } catch (const StartupFailure& failure) {
    return refuse(program, failure.what());
  } catch (const Unavailable& failure) {
    refuse(program, failure.what());
    return kExitFailure;
  } catch (const InUse& in_use) {
    refuse(program, in_use.what());
    return kExitInUse;
  } catch (const dds::StartupError& error) {
    return refuse(program, error.what());
  } catch (const std::exception& error) {
    log_critical("{}", error.what());
    return kExitFailure;
  }
}

}  // namespace

int run_service(int argc, char** argv, const ServiceDescription& description) {
  // not by the name: another program may take the service's place
  const std::string program = std::filesystem::path(argv[0]).filename();
  CLI::App command_line(description.purpose, program);
  ServiceOptions options;
  command_line.set_version_flag("--version", program + " " + std::string(kVersion));
  add_service_options(command_line, options);
  description.add_options(command_line);
  command_line.footer([&] {
    return "Settings of --config:\n" +
           config::explanation_lines(config::explain(description.stages));
  });
  try {
    command_line.parse(argc, argv);
  } catch (const CLI::ParseError& fault) { return answer(command_line, fault); }

  if (const auto fault = load_config(options, description.stages)) return refuse(program, *fault);
  if (options.print_config) std::cout << config::print(description.stages);
  if (options.print_config || options.check_config) return 0;
  set_up_log(description.name);
  std::signal(SIGPIPE, SIG_IGN);
  if (description.gives_way) give_way();  // before there are other threads
  return serve_or_say_why_not(program, description, options);
}

}  // namespace slammot::app
