#include "services/inspector/bus_options.hpp"

#include "common/app/service_options.hpp"

namespace slammot::inspector {

void add_bus_options(CLI::App& command, BusOptions& options) {
  app::add_domain_option(command, options.domain_id);
}

}  // namespace slammot::inspector
