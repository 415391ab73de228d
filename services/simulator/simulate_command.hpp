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
};

/// `slammot simulate`: names the scenarios or drives one and writes its files. Returns the
/// process's exit code.
int simulate(const SimulateOptions& options, std::ostream& out, std::ostream& err);

/// Adds the subcommand to a command line; when it was given, exit_code is set while parsing.
void add_simulate_command(CLI::App& app, int& exit_code);

}  // namespace slammot::simulator
