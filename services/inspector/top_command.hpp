#pragma once

namespace CLI {
class App;
}

namespace slammot::inspector {

/// Adds `slammot top`: a live table of services and topics.
void add_top_command(CLI::App& app, int& exit_code);

}  // namespace slammot::inspector
