#pragma once

namespace CLI {
class App;
}

namespace slammot::evaluator {

/// Adds `slammot eval`: a run against the truth. exit_code is set when the command has run and must
/// outlive the app.
void add_eval_command(CLI::App& app, int& exit_code);

}  // namespace slammot::evaluator
