#pragma once

namespace CLI {
class App;
}

namespace slammot {

/// Adds `slammot bench`: processes a drive by the real services, over DDS on this machine.
/// `exit_code` is set when the command has run and must outlive `app`.
void add_bench_command(CLI::App& app, int& exit_code);

}  // namespace slammot
