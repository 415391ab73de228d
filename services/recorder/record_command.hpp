#pragma once

namespace CLI {
class App;
}

namespace slammot::recorder {

/// Adds `slammot record`: the service, in the foreground. `exit_code` is set when the command has
/// run and must outlive `app`.
void add_record_command(CLI::App& app, int& exit_code);

/// Adds `slammot play`: plays a recording onto the bus.
void add_play_command(CLI::App& app, int& exit_code);

}  // namespace slammot::recorder
