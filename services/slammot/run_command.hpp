#pragma once

namespace CLI {
class App;
}

namespace slammot {

/// Adds `slammot run`: a drive through all stages in this one process, the same result every time.
/// exit_code is set when the command has run and must outlive the app.
void add_run_command(CLI::App& app, int& exit_code);

}  // namespace slammot
