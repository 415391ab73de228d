#pragma once

namespace CLI {
class App;
}

namespace slammot::evaluator {

/// Adds `slammot report`: one HTML page about a run. `exit_code` is set when the command has run
/// and must outlive `app`.
void add_report_command(CLI::App& app, int& exit_code);

}  // namespace slammot::evaluator
