#include "services/inspector/qos_command.hpp"

#include <cstdio>
#include <memory>
#include <set>

#include <CLI/CLI.hpp>

#include "common/files/failure.hpp"
#include "services/inspector/bus_view.hpp"
#include "services/inspector/calls.hpp"
#include "services/inspector/qos_report.hpp"
#include "services/inspector/topic_choice.hpp"

namespace slammot::inspector {
namespace {

int report(const BusOptions& options, const std::string& word) {
  const BusView view(options);
  std::set<std::string> topics = view.topic_names();
  if (!word.empty()) {
    const auto topic = topic_meant(word, topics);
    if (!topic) return files::fail(unknown_topic(word, topics));
    topics = {*topic};
  }
  std::size_t apart = 0;
  for (const std::string& topic : topics) {
    std::fputs(qos_report(view.discovery(), topic).c_str(), stdout);
    apart += mismatches(view.discovery(), topic).size();
  }
  std::printf("%zu topics, %zu pairs not connected\n", topics.size(), apart);
  return apart == 0 ? kExitDone : kExitFault;
}

}  // namespace

void add_qos_command(CLI::App& app, int& exit_code) {
  struct Options {
    BusOptions bus;
    std::string topic;
  };
  CLI::App* const command =
      app.add_subcommand("qos", "Show the QoS of topics, and why endpoints are not connected");
  const auto options = std::make_shared<Options>();
  add_bus_options(*command, options->bus);
  command->add_option("topic", options->topic, "Name, with or without slammot/; default: all");
  command->callback([options, &exit_code] {
    exit_code = guarded([&] { return report(options->bus, options->topic); });
  });
}

}  // namespace slammot::inspector
