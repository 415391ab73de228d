#include "services/inspector/doctor_command.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "services/inspector/bus_view.hpp"
#include "services/inspector/calls.hpp"
#include "services/inspector/doctor_checks.hpp"

namespace slammot::inspector {
namespace {

Finding look_at_domain(const BusOptions& options) {
  try {
    const BusView view(options);
    std::vector<dds::Peer> peers;
    for (const auto& [guid, peer] : view.discovery().peers()) {
      if (peer.name != "slammot-inspector") peers.push_back(peer);
    }
    return finding_of_domain(options.domain_id, peers);
  } catch (const dds::StartupError& error) {
    return {"domain", false, error.what(), "correct CYCLONEDDS_URI or the network"};
  }
}

int examine(const BusOptions& options, const std::string& state_folder) {
  std::vector<Finding> findings = findings_of(examine_computer(state_folder));
  findings.push_back(look_at_domain(options));
  std::fputs(findings_text(findings).c_str(), stdout);
  return std::ranges::all_of(findings, &Finding::is_good) ? kExitDone : kExitFault;
}

}  // namespace

void add_doctor_command(CLI::App& app, int& exit_code) {
  struct Options {
    BusOptions bus;
    std::string state_folder = "slammot-state";
  };
  CLI::App* const command =
      app.add_subcommand("doctor", "Check this computer before a run, and say what to change");
  const auto options = std::make_shared<Options>();
  add_bus_options(*command, options->bus);
  command->add_option("--state-dir", options->state_folder, "Folder of the services' state")
      ->capture_default_str();
  command->callback([options, &exit_code] {
    exit_code = guarded([&] { return examine(options->bus, options->state_folder); });
  });
}

}  // namespace slammot::inspector
