#pragma once

namespace CLI {
class App;
}

namespace slammot {

/// Adds `slammot config`: what settings there are, and those that a run would use.
/// exit_code is set when the command has run and must outlive the app.
void add_config_command(CLI::App& app, int& exit_code);

}  // namespace slammot
