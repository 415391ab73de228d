#pragma once

namespace CLI {
class App;
}

namespace slammot::evaluator {

/// Adds `slammot plot` and `slammot animate`: pictures of a result. `exit_code` is set when a
/// command has run and must outlive `app`.
void add_plot_command(CLI::App& app, int& exit_code);
void add_animate_command(CLI::App& app, int& exit_code);

}  // namespace slammot::evaluator
