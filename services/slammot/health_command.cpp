#include "services/slammot/health_command.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/app/health.hpp"
#include "common/app/service_options.hpp"
#include "services/slammot/command_line.hpp"

namespace slammot {
namespace {

using namespace std::chrono_literals;

/// Every service sends its heartbeat five times and its status once in this time.
constexpr auto kTimeToLookForAll = 1200ms;

struct HealthOptions {
  app::HealthQuestion question;
  bool is_alive_enough = false;
};

std::string name_of(const app::Health& health, bool with_vehicle) {
  std::string name = with_vehicle ? health.name.vehicle_id + " " : "";
  name += health.name.service;
  if (!health.name.instance.empty() && health.name.instance != "main")
    name += " " + health.name.instance;
  if (health.process_number != 0)
    name += " (process " + std::to_string(health.process_number) + ")";
  return name;
}

/// Of the services that stand on the way of a scan and keep its map, those that the vehicle lacks.
std::vector<std::string> missing(const std::vector<app::Health>& healths,
                                 const std::string& vehicle_id) {
  const auto runs = [&](const char* service) {
    return std::ranges::any_of(healths, [&](const app::Health& health) {
      return health.name.vehicle_id == vehicle_id && health.name.service == service;
    });
  };
  std::vector<std::string> names;
  if (!runs("localization")) return names;
  for (const char* service : {"detection", "tracking", "map_store", "loop_closing"}) {
    if (!runs(service)) names.emplace_back(service);
  }
  return names;
}

/// A service that ended leaves nothing on the bus by which it could be known.
void print_missing(const std::vector<app::Health>& healths, bool with_vehicle) {
  std::set<std::string> vehicles;
  for (const app::Health& health : healths) vehicles.insert(health.name.vehicle_id);
  for (const std::string& vehicle : vehicles) {
    for (const std::string& service : missing(healths, vehicle))
      std::printf("%s%s: not heard\n", with_vehicle ? (vehicle + " ").c_str() : "",
                  service.c_str());
  }
}

int exit_code_of(app::Verdict verdict, bool is_alive_enough) {
  if (verdict == app::Verdict::kDown) return kExitDown;
  return verdict == app::Verdict::kDegraded && !is_alive_enough ? int{kExitDegraded}
                                                                : int{kExitDone};
}

int ask(const HealthOptions& options) {
  try {
    const auto healths = app::check_health(options.question);
    for (const app::Health& health : healths)
      std::printf("%s: %s\n", name_of(health, options.question.vehicle_id.empty()).c_str(),
                  health.text.c_str());
    if (options.question.services.empty())
      print_missing(healths, options.question.vehicle_id.empty());
    if (healths.empty()) std::printf("no service on domain %u\n", options.question.domain_id);
    return exit_code_of(app::verdict_of(healths), options.is_alive_enough);
  } catch (const std::runtime_error& fault) {
    std::fprintf(stderr, "slammot: %s\n", fault.what());
    return kExitUsage;
  }
}

}  // namespace

void add_health_command(CLI::App& app, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand("health", "Report whether services are alive and ready");
  const auto options = std::make_shared<HealthOptions>();
  app::HealthQuestion& question = options->question;
  command->add_option("services", question.services,
                      "Names, such as localization map_store; default: all on the bus");
  CLI::Option* const vehicle =
      command
          ->add_option("--vehicle", question.vehicle_id,
                       "Vehicle of the services; without names of services default: any")
          ->envname("SLAMMOT_VEHICLE")
          ->capture_default_str();
  command->add_option("--instance", question.instance, "Instance, if several run; default: any");
  command->add_flag("--alive", options->is_alive_enough,
                    "Exit code 0 also when degraded, for a supervisor that would restart it");
  app::add_domain_option(*command, question.domain_id);
  command->footer(
      "Exit codes: 0 good, 1 down, 2 usage, 3 degraded. Services that are not heard count "
      "where they are named.");
  command->callback([options, vehicle, &exit_code] {
    if (options->question.services.empty()) {
      options->question.patience = kTimeToLookForAll;
      if (vehicle->count() == 0) options->question.vehicle_id.clear();
    }
    exit_code = ask(*options);
  });
}

}  // namespace slammot
