#pragma once

namespace CLI {
class App;
}

namespace slammot::evaluator {

/// Adds `slammot report`: one page of HTML about a run. exit_code is set when the command has run
/// and must outlive the app.
void add_report_command(CLI::App& app, int& exit_code);

}  // namespace slammot::evaluator
