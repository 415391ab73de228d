#pragma once

#include <string>

namespace CLI {
class App;
}

namespace slammot::app {

/// Adds --bus, also of the environment, for a command that starts a closed bus on this machine;
/// `bus` must outlive the parsing. Other commands have the option with --domain: it sets their
/// process' CYCLONEDDS_URI.
void add_bus_option(CLI::App& command_line, std::string& bus);

}  // namespace slammot::app
