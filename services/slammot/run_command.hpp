#pragma once

namespace CLI {
class App;
}

namespace slammot {

/// Adds `slammot run`: processes a drive in this process, reproducibly. `exit_code` is set when the
/// command has run and must outlive `app`.
void add_run_command(CLI::App& app, int& exit_code);

}  // namespace slammot
