#pragma once

namespace CLI {
class App;
}

namespace slammot::inspector {

/// Adds `slammot qos [TOPIC]`: QoS of all endpoints, and why pairs are not connected; exit code 1
/// if there are such pairs.
void add_qos_command(CLI::App& app, int& exit_code);

}  // namespace slammot::inspector
