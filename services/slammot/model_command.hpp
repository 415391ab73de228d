#pragma once

namespace CLI {
class App;
}

namespace slammot {

/// Adds `slammot model`: the 2.5-D model of a city from a vertical scanner and a run's result.
void add_model_command(CLI::App& app, int& exit_code);

}  // namespace slammot
