#pragma once

namespace CLI {
class App;
}

namespace slammot {

/// Adds `slammot health SERVICE`: whether a service is at work, as a line and as the exit code.
/// exit_code is set when the command has run and must outlive the app.
void add_health_command(CLI::App& app, int& exit_code);

}  // namespace slammot
