#pragma once

namespace CLI {
class App;
}

namespace slammot {

/// Adds `slammot collect`: writes the outputs of services that run elsewhere. `exit_code` is set
/// when the command has run and must outlive `app`.
void add_collect_command(CLI::App& app, int& exit_code);

}  // namespace slammot
