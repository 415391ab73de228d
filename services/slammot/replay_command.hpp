#pragma once

namespace CLI {
class App;
}

namespace slammot {

/// Adds `replay`, which sets the exit code when the command is parsed.
void add_replay_command(CLI::App& app, int& exit_code);

}  // namespace slammot
