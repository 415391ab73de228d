#pragma once

namespace CLI {
class App;
}

namespace slammot::recorder {

/// Adds `slammot bag info|verify|recover|cut|merge`. `exit_code` is set when the command has run
/// and must outlive `app`.
void add_bag_command(CLI::App& app, int& exit_code);

}  // namespace slammot::recorder
