#pragma once

namespace CLI {
class App;
}

namespace slammot {

/// Adds `convert` to `bag`, which must have been added; it sets the exit code when the command is
/// parsed.
void add_convert_command(CLI::App& app, int& exit_code);

}  // namespace slammot
