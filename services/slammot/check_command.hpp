#pragma once

namespace CLI {
class App;
}

namespace slammot {

/// Adds `slammot check`: what is in a log, what will be assumed, what is doubtful, and the command
/// to run. exit_code is set when the command has run and must outlive the app.
void add_check_command(CLI::App& app, int& exit_code);

}  // namespace slammot
