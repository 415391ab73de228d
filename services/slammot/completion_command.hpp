#pragma once

namespace CLI {
class App;
}

namespace slammot {

/// Adds `slammot completion`, which prints a script that completes words of this program in a
/// shell. Call after all other commands are added: it tells of them. `exit_code` is set when the
/// command has run; both must outlive the parsing.
void add_completion_command(CLI::App& app, int& exit_code);

}  // namespace slammot
