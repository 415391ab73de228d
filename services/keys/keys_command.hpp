#pragma once

namespace CLI {
class App;
}

namespace slammot::keys {

/// Adds `slammot keys init|issue|revoke|list FOLDER`: a development authority for DDS Security, and
/// identities of the services. Sets `exit_code` when called.
void add_keys_command(CLI::App& app, int& exit_code);

}  // namespace slammot::keys
