#pragma once

namespace CLI {
class App;
}

namespace slammot::inspector {

/// Adds `slammot doctor`: checks the computer before a run and says what to change; exit code 1 if
/// something is to be changed.
void add_doctor_command(CLI::App& app, int& exit_code);

}  // namespace slammot::inspector
