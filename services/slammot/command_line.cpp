#include "services/slammot/command_line.hpp"

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "services/evaluator/eval_command.hpp"
#include "services/evaluator/plot_command.hpp"
#include "services/evaluator/report_command.hpp"
#include "services/inspector/doctor_command.hpp"
#include "services/inspector/graph_command.hpp"
#include "services/inspector/qos_command.hpp"
#include "services/inspector/top_command.hpp"
#include "services/inspector/topic_commands.hpp"
#include "services/keys/keys_command.hpp"
#include "services/recorder/bag_command.hpp"
#include "services/recorder/record_command.hpp"
#include "services/simulator/simulate_command.hpp"
#include "services/slammot/bench_command.hpp"
#include "services/slammot/check_command.hpp"
#include "services/slammot/collect_command.hpp"
#include "services/slammot/completion_command.hpp"
#include "services/slammot/config_command.hpp"
#include "services/slammot/convert_command.hpp"
#include "services/slammot/health_command.hpp"
#include "services/slammot/live_command.hpp"
#include "services/slammot/map_command.hpp"
#include "services/slammot/model_command.hpp"
#include "services/slammot/replay_command.hpp"
#include "services/slammot/run_command.hpp"
#include "services/slammot/streets_command.hpp"
#include "services/slammot/usage.hpp"
#include "services/slammot/warn_command.hpp"

namespace slammot {
namespace {

struct Group {
  const char* title;
  std::vector<const char*> commands;
};

/// What `slammot` alone lists. Commands that are in no group are listed as others.
const std::vector<Group>& groups() {
  static const std::vector<Group> kGroups = {
      {"Process a drive", {"run", "bench", "live", "collect", "simulate"}},
      {"Look at a drive or a result",
       {"check", "report", "plot", "animate", "eval", "warn", "streets", "model"}},
      {"Recordings of the bus", {"record", "play", "replay", "bag"}},
      {"Settings, maps and keys", {"config", "map", "keys"}},
      {"Services that run",
       {"health", "top", "list", "echo", "hz", "delay", "qos", "graph", "doctor"}},
      {"Shell", {"completion"}}};
  return kGroups;
}

void set_groups(CLI::App& app) {
  const auto group_of = [](const std::string& name) {
    for (const Group& group : groups()) {
      for (const char* const command : group.commands)
        if (name == command) return group.title;
    }
    return "Others";
  };
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; }))
    command->group(group_of(command->get_name()));
}

/// "help run" as "run --help", "version" as "--version".
std::vector<std::string> with_options(std::vector<std::string> words) {
  if (words.front() != "help" && words.front() != "version") return words;
  std::rotate(words.begin(), words.begin() + 1, words.end());
  words.back().insert(0, "--");
  return words;
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
  evaluator::add_plot_command(app, exit_code);
  evaluator::add_animate_command(app, exit_code);
  inspector::add_top_command(app, exit_code);
  inspector::add_list_command(app, exit_code);
  inspector::add_echo_command(app, exit_code);
  inspector::add_hz_command(app, exit_code);
  inspector::add_delay_command(app, exit_code);
  inspector::add_qos_command(app, exit_code);
  inspector::add_graph_command(app, exit_code);
  inspector::add_doctor_command(app, exit_code);
  add_warn_command(app, exit_code);
  add_streets_command(app, exit_code);
  add_model_command(app, exit_code);
  recorder::add_record_command(app, exit_code);
  recorder::add_play_command(app, exit_code);
  add_replay_command(app, exit_code);
  recorder::add_bag_command(app, exit_code);
  keys::add_keys_command(app, exit_code);
  add_convert_command(app, exit_code);
  add_completion_command(app, exit_code);
  set_groups(app);
  if (argc < 2) {
    std::fputs(app.help().c_str(), stdout);
    return kExitUsage;
  }
  std::vector<std::string> words = with_options({argv + 1, argv + argc});
  if (const auto fault = unknown_word(app, words)) {
    std::fprintf(stderr, "slammot: %s\n", fault->c_str());
    return kExitUsage;
  }
  try {
    std::ranges::reverse(words);  // as CLI11 takes them
    app.parse(std::move(words));
  } catch (const CLI::ParseError& fault) {
    if (fault.get_exit_code() == 0) return app.exit(fault);  // --help, --version
    std::fprintf(stderr, "%s\n", explain(app, fault).c_str());
    return kExitUsage;
  }
  return exit_code;
}

}  // namespace slammot
