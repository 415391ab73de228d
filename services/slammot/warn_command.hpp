#pragma once

namespace CLI {
class App;
}

namespace slammot {

/// Adds `slammot warn`: collision warnings of a finished run. `exit_code` is set when the command
/// has run and must outlive `app`.
void add_warn_command(CLI::App& app, int& exit_code);

}  // namespace slammot
