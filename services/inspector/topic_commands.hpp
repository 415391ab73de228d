#pragma once

namespace CLI {
class App;
}

namespace slammot::inspector {

/// Add `slammot list`, `echo`, `hz` and `delay`, which look at topics of any type. Each sets
/// `exit_code` when called.
void add_list_command(CLI::App& app, int& exit_code);
void add_echo_command(CLI::App& app, int& exit_code);
void add_hz_command(CLI::App& app, int& exit_code);
void add_delay_command(CLI::App& app, int& exit_code);

}  // namespace slammot::inspector
