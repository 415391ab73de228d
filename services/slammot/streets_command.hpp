#pragma once

namespace CLI {
class App;
}

namespace slammot {

/// Adds the subcommand `streets`: finds a trajectory in a street graph.
void add_streets_command(CLI::App& app, int& exit_code);

}  // namespace slammot
