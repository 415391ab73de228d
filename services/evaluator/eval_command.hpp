#pragma once

namespace CLI {
class App;
}

namespace slammot::evaluator {

/// Adds `slammot eval`: evaluates a run against ground truth. `exit_code` is set when the command
/// has run and must outlive `app`.
void add_eval_command(CLI::App& app, int& exit_code);

}  // namespace slammot::evaluator
