#include "services/slammot/command_line.hpp"

#include <CLI/CLI.hpp>

#include "services/evaluator/eval_command.hpp"
#include "services/evaluator/report_command.hpp"
#include "services/simulator/simulate_command.hpp"
#include "services/slammot/bench_command.hpp"
#include "services/slammot/collect_command.hpp"
#include "services/slammot/health_command.hpp"
#include "services/slammot/run_command.hpp"

namespace slammot {

int run_command_line(int argc, char** argv) {
  CLI::App app{"Localization, mapping and moving object tracking from a vehicle's laser scanners", "slammot"};
  app.set_version_flag("--version", "slammot " SLAMMOT_VERSION);
  app.require_subcommand(1);
  int exit_code = kExitDone;
  add_run_command(app, exit_code);
  add_bench_command(app, exit_code);
  add_collect_command(app, exit_code);
  add_health_command(app, exit_code);
  simulator::add_simulate_command(app, exit_code);
  evaluator::add_eval_command(app, exit_code);
  evaluator::add_report_command(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& fault) {
    return app.exit(fault) == 0 ? kExitDone : kExitFault;
  }
  return exit_code;
}

}  // namespace slammot
