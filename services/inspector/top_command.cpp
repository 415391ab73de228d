#include "services/inspector/top_command.hpp"

#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <map>
#include <memory>
#include <tuple>

#include <CLI/CLI.hpp>

#include "common/app/stop_signal.hpp"
#include "common/app/system_clock.hpp"
#include "common/dds/reader.hpp"
#include "common/files/decimal.hpp"
#include "common/files/number_option.hpp"
#include "services/inspector/bus_view.hpp"
#include "services/inspector/calls.hpp"
#include "services/inspector/table_text.hpp"
#include "services/inspector/top_text.hpp"

namespace slammot::inspector {
namespace {

using namespace std::chrono_literals;

struct TopOptions {
  BusOptions bus;
  double period_s = 1.0;
  bool is_once = false;
};

/// The last status of each process that reported within a few seconds.
class Services {
 public:
  explicit Services(const dds::Participant& participant)
      : statuses_(participant, dds::topics::kStatus) {}

  std::vector<wire::ServiceStatus> update() {
    const auto now = std::chrono::steady_clock::now();
    statuses_.take_each([&](const slammot_ServiceStatus& sample) {
      const auto status = wire::decode(sample);
      if (status) known_[key_of(*status)] = {*status, now};
    });
    std::erase_if(known_, [&](const auto& one) { return now - one.second.last > kForgottenAfter; });
    std::vector<wire::ServiceStatus> services;
    for (const auto& [key, known] : known_) services.push_back(known.status);
    return services;
  }

 private:
  static constexpr auto kForgottenAfter = 5s;
  using Key = std::tuple<std::string, std::string, std::string, std::uint32_t>;
  struct Known {
    wire::ServiceStatus status;
    std::chrono::steady_clock::time_point last;
  };
  static Key key_of(const wire::ServiceStatus& status) {
    return {status.name.vehicle_id, status.name.service, status.name.instance,
            status.process_number};
  }

  dds::Reader<slammot_ServiceStatus> statuses_;
  std::map<Key, Known> known_;
};

std::vector<TopicLine> topic_lines(BusView& view, double interval_s) {
  std::map<std::string, TopicLine> lines;
  for (const auto& [guid, endpoint] : view.discovery().endpoints()) {
    TopicLine& line = lines[endpoint.topic];
    line.topic = endpoint.topic;
    ++(endpoint.is_writer ? line.writers : line.readers);
  }
  std::vector<TopicLine> result;
  for (auto& [name, line] : lines) {
    const auto watched = view.topics().find(name);
    if (watched != view.topics().end()) {
      line.figures = watched->second.meter.figures(interval_s);
      line.age_s = watched->second.meter.age_s(app::system_clock_ns());
      line.lost = static_cast<std::uint32_t>(watched->second.reader->counters().lost);
      watched->second.meter.reset();
    }
    if (line.writers > 0) result.push_back(line);
  }
  return result;
}

int top(const TopOptions& options) {
  std::atomic<bool> is_stopped = false;
  const app::StopSignal stop_signal([&] { is_stopped = true; });
  BusView view(options.bus);
  Services services(view.participant());
  view.receive(200ms, true);  // the endpoints find each other; what late joiners get is no rate
  for (auto& [name, watched] : view.topics()) watched.meter.reset();
  while (!is_stopped) {
    const auto start = std::chrono::steady_clock::now();
    const auto period = std::chrono::duration<double>(options.period_s);
    while (!is_stopped && std::chrono::steady_clock::now() - start < period)
      view.receive(100ms, true);
    const std::chrono::duration<double> interval = std::chrono::steady_clock::now() - start;
    const std::string text = services_text(services.update(), app::system_clock_ns()) + "\n" +
                             topics_text(topic_lines(view, interval.count()));
    const bool clears = !options.is_once && ::isatty(STDOUT_FILENO) != 0;
    std::printf("%sdomain %u; services: since their start, topics: figures of %s s\n\n%s",
                clears ? "\x1b[H\x1b[2J" : "", options.bus.domain_id,
                files::fixed_text(interval.count(), 1).c_str(), text.c_str());
    std::fflush(stdout);
    if (options.is_once) break;
  }
  return kExitDone;
}

}  // namespace

void add_top_command(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<TopOptions>();
  CLI::App* const command =
      app.add_subcommand("top", "Show services and topics: state, rate, age, size, drops, latency");
  add_bus_options(*command, options->bus);
  command->add_option("--period", options->period_s, "Time between two tables [s]")
      ->check(files::number_between(0.1, 3600.0))
      ->capture_default_str();
  command->add_flag("--once", options->is_once, "Print one table and end");
  command->callback([options, &exit_code] { exit_code = guarded([&] { return top(*options); }); });
}

}  // namespace slammot::inspector
