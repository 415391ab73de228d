#pragma once

namespace CLI {
class App;
}

namespace slammot {

/// Adds `slammot map`: work on stored maps. `exit_code` is set when the command has run and must
/// outlive `app`.
void add_map_command(CLI::App& app, int& exit_code);

}  // namespace slammot
