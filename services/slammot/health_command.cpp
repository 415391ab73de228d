#include "services/slammot/health_command.hpp"

#include <cstdio>
#include <memory>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "common/app/health.hpp"
#include "services/slammot/command_line.hpp"

namespace slammot {
namespace {

constexpr int kExitUnhealthy = 1;

int ask(const app::HealthQuestion& question) {
  try {
    const app::Health health = app::check_health(question);
    std::printf("%s: %s\n", question.service.c_str(), health.text.c_str());
    return health.is_healthy ? kExitDone : kExitUnhealthy;
  } catch (const std::runtime_error& fault) {
    std::fprintf(stderr, "slammot: %s\n", fault.what());
    return kExitFault;
  }
}

}  // namespace

void add_health_command(CLI::App& app, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand("health", "Report whether a service is alive and ready");
  const auto question = std::make_shared<app::HealthQuestion>();
  command
      ->add_option("service", question->service,
                   "Name of the service, such as localization or map_store")
      ->required();
  command->add_option("--vehicle", question->vehicle_id, "Vehicle of the service")
      ->envname("SLAMMOT_VEHICLE")
      ->capture_default_str();
  command->add_option("--instance", question->instance, "Instance, if several run; default: any");
  command->add_option("--domain", question->domain_id, "DDS domain")
      ->envname("SLAMMOT_DOMAIN")
      ->check(CLI::Range(0, 230))
      ->capture_default_str();
  command->callback([question, &exit_code] { exit_code = ask(*question); });
}

}  // namespace slammot
