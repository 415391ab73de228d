#pragma once

namespace CLI {
class App;
}

namespace slammot {

/// Adds `slammot collect`: writes what services elsewhere make of a drive.
/// exit_code is set when the command has run and must outlive the app.
void add_collect_command(CLI::App& app, int& exit_code);

}  // namespace slammot
