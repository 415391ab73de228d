#pragma once

namespace CLI {
class App;
}

namespace slammot {

/// Adds `slammot config`: explains the settings, or prints those of a run. `exit_code` is set when
/// the command has run and must outlive `app`.
void add_config_command(CLI::App& app, int& exit_code);

}  // namespace slammot
