#pragma once

namespace CLI {
class App;
}

namespace slammot {

/// Adds `slammot live`: a simulated drive through the services, shown by the gateway.
void add_live_command(CLI::App& app, int& exit_code);

}  // namespace slammot
