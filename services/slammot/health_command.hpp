#pragma once

namespace CLI {
class App;
}

namespace slammot {

/// Exit codes of `slammot health`, besides kExitDone, and kExitUsage where the bus cannot be
/// joined.
enum HealthExitCode : int {
  kExitDown = 1,      ///< A service is not heard, has not started, or stops.
  kExitDegraded = 3,  ///< All work, and one lacks an input or has a fault.
};

/// Adds `slammot health [SERVICE...]`: reports the health of services, a line each, and the worst
/// one as an exit code. Without names, of all that are on the bus. Sets `exit_code` when called.
void add_health_command(CLI::App& app, int& exit_code);

}  // namespace slammot
