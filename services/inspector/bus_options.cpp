#include "services/inspector/bus_options.hpp"

#include <CLI/CLI.hpp>

namespace slammot::inspector {

void add_bus_options(CLI::App& command, BusOptions& options) {
  command.add_option("--domain", options.domain_id, "DDS domain")
      ->envname("SLAMMOT_DOMAIN")
      ->check(CLI::Range(0, 230))
      ->capture_default_str();
}

}  // namespace slammot::inspector
