#pragma once

namespace CLI {
class App;
}

namespace slammot {

/// Adds `slammot health SERVICE`: reports the health of a service as a line and an exit code.
/// `exit_code` is set when the command has run and must outlive `app`.
void add_health_command(CLI::App& app, int& exit_code);

}  // namespace slammot
