#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace slammot::simulator {

struct SimulateOptions {
  bool list = false;
  std::string scenario;
  std::optional<std::uint64_t> seed;
  std::string output;
  bool hits = false;
  bool streets = false;        ///< Writes the city's street graph and no drive,
  std::string without_street;  ///< without this street; empty: all.
};

/// Runs `slammot simulate`: lists scenarios, or simulates one and writes its files. Returns the
/// exit code.
int simulate(const SimulateOptions& options, std::ostream& out, std::ostream& err);

/// Adds the subcommand. Parsing sets `exit_code` if it is given.
void add_simulate_command(CLI::App& app, int& exit_code);

}  // namespace slammot::simulator
