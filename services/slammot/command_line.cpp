#include "services/slammot/command_line.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/config/nearest.hpp"
#include "services/evaluator/eval_command.hpp"
#include "services/evaluator/report_command.hpp"
#include "services/inspector/doctor_command.hpp"
#include "services/inspector/graph_command.hpp"
#include "services/inspector/qos_command.hpp"
#include "services/inspector/top_command.hpp"
#include "services/inspector/topic_commands.hpp"
#include "services/simulator/simulate_command.hpp"
#include "services/slammot/bench_command.hpp"
#include "services/slammot/check_command.hpp"
#include "services/slammot/collect_command.hpp"
#include "services/slammot/config_command.hpp"
#include "services/slammot/health_command.hpp"
#include "services/slammot/live_command.hpp"
#include "services/slammot/map_command.hpp"
#include "services/slammot/run_command.hpp"
#include "services/slammot/warn_command.hpp"

namespace slammot {
namespace {

std::vector<std::string> commands_of(CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

bool is_one_of(const std::string& word, const std::vector<std::string>& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Message about an unknown command, or an unknown option of a command.
std::optional<std::string> unknown_word(CLI::App& app, const std::vector<std::string>& words) {
  if (words.empty() || words.front().starts_with("-")) return std::nullopt;
  const std::vector<std::string> commands = commands_of(app);
  if (!is_one_of(words.front(), commands)) {
    return "unknown command '" + words.front() + "'" +
           config::hint_at_nearest(words.front(), commands) + "; slammot --help lists all";
  }
  CLI::App* command = app.get_subcommand(words.front());
  std::string name_of_command = words.front();
  auto word = words.begin() + 1;
  for (; word != words.end() && is_one_of(*word, commands_of(*command)); ++word) {
    command = command->get_subcommand(*word);
    name_of_command += " " + *word;
  }
  const std::vector<std::string> parts = commands_of(*command);
  if (!parts.empty() && word != words.end() && !word->starts_with("-"))
    return "unknown command '" + name_of_command + " " + *word + "'" +
           config::hint_at_nearest(*word, parts) + "; slammot " + name_of_command +
           " --help lists all";
  const std::vector<std::string> options = options_of(*command);
  for (; word != words.end() && *word != "--"; ++word) {
    const std::string name = word->substr(0, word->find('='));
    if (!name.starts_with("--") || is_one_of(name, options)) continue;
    return "unknown option '" + name + "' of " + name_of_command +
           config::hint_at_nearest(name, options) + "; slammot " + name_of_command +
           " --help lists all";
  }
  return std::nullopt;
}

}  // namespace

int run_command_line(int argc, char** argv) {
  CLI::App app{"Localization, mapping and moving object tracking from a vehicle's laser scanners",
               "slammot"};
  app.set_version_flag("--version", "slammot " SLAMMOT_VERSION);
  app.require_subcommand(1);
  int exit_code = kExitDone;
  add_run_command(app, exit_code);
  add_bench_command(app, exit_code);
  add_check_command(app, exit_code);
  add_collect_command(app, exit_code);
  add_config_command(app, exit_code);
  add_health_command(app, exit_code);
  add_live_command(app, exit_code);
  add_map_command(app, exit_code);
  simulator::add_simulate_command(app, exit_code);
  evaluator::add_eval_command(app, exit_code);
  evaluator::add_report_command(app, exit_code);
  inspector::add_top_command(app, exit_code);
  inspector::add_list_command(app, exit_code);
  inspector::add_echo_command(app, exit_code);
  inspector::add_hz_command(app, exit_code);
  inspector::add_delay_command(app, exit_code);
  inspector::add_qos_command(app, exit_code);
  inspector::add_graph_command(app, exit_code);
  inspector::add_doctor_command(app, exit_code);
  add_warn_command(app, exit_code);
  if (argc < 2) {
    std::fputs(app.help().c_str(), stdout);
    return kExitFault;
  }
  if (const auto fault = unknown_word(app, {argv + 1, argv + argc})) {
    std::fprintf(stderr, "slammot: %s\n", fault->c_str());
    return kExitFault;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& fault) {
    const int usage = app.got_subcommand("health") ? int{kExitUsage} : int{kExitFault};
    return app.exit(fault) == 0 ? int{kExitDone} : usage;
  }
  return exit_code;
}

}  // namespace slammot
