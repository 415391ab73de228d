#pragma once

namespace CLI {
class App;
}

namespace slammot {

/// Adds `slammot bench`: a drive through the real services over DDS on this machine.
/// exit_code is set when the command has run and must outlive the app.
void add_bench_command(CLI::App& app, int& exit_code);

}  // namespace slammot
