#include "common/app/run_service.hpp"

#include <csignal>
#include <filesystem>
#include <iostream>

#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include "common/app/log.hpp"
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

/// The service is destroyed before the context that it refers to, and both before the watchdog
/// stops.
int serve(const ServiceDescription& description, const ServiceOptions& options) {
  dds::ExitWatchdog watchdog;
  ServiceContext context(description.name, options);
  const StopSignal stop_signal([&] {
    watchdog.arm();  // also guards against a handler that does not return
    context.stop();
  });
  const std::shared_ptr<void> service = description.make(context);
  spdlog::info("vehicle {} in DDS domain {}", options.vehicle_id, options.domain_id);
  context.run();
  return context.exit_code();
}

int serve_or_say_why_not(const std::string& program, const ServiceDescription& description,
                         const ServiceOptions& options) {
  try {
    return serve(description, options);
  } catch (const StartupFailure& failure) {
    return refuse(program, failure.what());
  } catch (const dds::StartupError& error) {
    return refuse(program, error.what());
  } catch (const std::exception& error) {
    spdlog::critical("{}", error.what());
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
  CLI11_PARSE(command_line, argc, argv);

  if (const auto fault = load_config(options, description.stages)) return refuse(program, *fault);
  if (options.print_config) std::cout << config::print(description.stages);
  if (options.print_config || options.check_config) return 0;
  set_up_log(description.name);
  std::signal(SIGPIPE, SIG_IGN);
  return serve_or_say_why_not(program, description, options);
}

}  // namespace slammot::app
