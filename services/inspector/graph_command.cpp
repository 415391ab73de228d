#include "services/inspector/graph_command.hpp"

#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "services/inspector/bus_view.hpp"
#include "services/inspector/calls.hpp"
#include "services/inspector/graph_text.hpp"

namespace slammot::inspector {

void add_graph_command(CLI::App& app, int& exit_code) {
  struct Options {
    BusOptions bus;
    bool is_dot = false;
    bool with_status = false;
  };
  CLI::App* const command = app.add_subcommand("graph", "Show which process talks to which");
  const auto options = std::make_shared<Options>();
  add_bus_options(*command, options->bus);
  command->add_flag("--dot", options->is_dot,
                    "For Graphviz: slammot graph --dot | dot -Tsvg > graph.svg");
  command->add_flag("--status", options->with_status,
                    "With heartbeats, statuses, commands and replies");
  command->callback([options, &exit_code] {
    exit_code = guarded([&] {
      const BusView view(options->bus);
      const auto found = links(view.discovery(), options->with_status);
      std::fputs((options->is_dot ? graph_dot(found) : graph_text(found)).c_str(), stdout);
      return kExitDone;
    });
  });
}

}  // namespace slammot::inspector
