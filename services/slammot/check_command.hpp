#pragma once

namespace CLI {
class App;
}

namespace slammot {

/// Adds `slammot check`: reports the content of a log, assumptions, doubtful findings and the
/// command to run. `exit_code` is set when the command has run and must outlive `app`.
void add_check_command(CLI::App& app, int& exit_code);

}  // namespace slammot
