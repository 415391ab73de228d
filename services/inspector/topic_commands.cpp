#include "services/inspector/topic_commands.hpp"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/app/stop_signal.hpp"
#include "common/files/decimal.hpp"
#include "common/files/failure.hpp"
#include "common/files/number_option.hpp"
#include "services/inspector/bus_options.hpp"
#include "services/inspector/bus_view.hpp"
#include "services/inspector/calls.hpp"
#include "services/inspector/sample_text.hpp"
#include "services/inspector/table_text.hpp"
#include "services/inspector/topic_choice.hpp"

namespace slammot::inspector {
namespace {

using namespace std::chrono_literals;

struct TopicOptions {
  BusOptions bus;
  std::string topic;
  std::uint64_t count = 0;  ///< 0: until Ctrl-C.
  double period_s = 1.0;
  bool is_full = false;  ///< Prints all elements of lists.
};

constexpr std::size_t kMostElements = 10;  ///< Of a list, in a line of `echo`.

/// Watches the topic of the options; an exit code if that cannot be.
std::optional<int> watch(BusView& view, TopicOptions& options) {
  const auto topic = topic_meant(options.topic, view.topic_names());
  if (!topic) return files::fail(unknown_topic(options.topic, view.topic_names()));
  options.topic = *topic;
  if (view.watch(*topic)) return std::nullopt;
  std::fprintf(stderr, "slammot: no writer of %s tells its type\n", topic->c_str());
  return kExitFault;
}

int list(const TopicOptions& options) {
  const BusView view(options.bus);
  struct Row {
    std::string type;
    int writers = 0, readers = 0;
  };
  std::map<std::string, Row> rows;
  for (const auto& [guid, endpoint] : view.discovery().endpoints()) {
    Row& row = rows[endpoint.topic];
    row.type = endpoint.type;
    ++(endpoint.is_writer ? row.writers : row.readers);
  }
  std::vector<std::vector<std::string>> lines;
  for (const auto& [name, row] : rows)
    lines.push_back({name, row.type, std::to_string(row.writers), std::to_string(row.readers)});
  std::fputs(table_text({"topic", "type", "writers", "readers"}, lines, 2).c_str(), stdout);
  return kExitDone;
}

int echo(TopicOptions options) {
  std::atomic<bool> is_stopped = false;
  const app::StopSignal stop_signal([&] { is_stopped = true; });
  BusView view(options.bus);
  if (const auto fault = watch(view, options)) return *fault;
  const std::size_t most = options.is_full ? SIZE_MAX : kMostElements;
  std::uint64_t printed = 0;
  view.on_sample([&](const dds::RawTopic& topic, const dds::RawSample& sample) {
    if (options.count > 0 && printed >= options.count) return;
    ++printed;
    std::printf("%s---\n", sample_text(topic.model(), sample.cdr, most).c_str());
    std::fflush(stdout);
  });
  while (!is_stopped && (options.count == 0 || printed < options.count)) view.receive(50ms, false);
  return kExitDone;
}

std::string rate_line(const TopicFigures& figures) {
  return files::fixed_text(figures.rate_hz, 2) + " Hz, gaps " +
         files::fixed_text(figures.shortest_gap_ms, 1) + " to " +
         files::fixed_text(figures.longest_gap_ms, 1) + " ms, sigma " +
         files::fixed_text(figures.gap_sigma_ms, 2) + " ms, " +
         files::fixed_text(figures.mean_bytes / 1000.0, 1) + " kB a sample";
}

std::string delay_line(const TopicFigures& figures) {
  return "delay p50 " + files::fixed_text(figures.delay_p50_ms, 2) + " ms, p99 " +
         files::fixed_text(figures.delay_p99_ms, 2) + " ms, worst " +
         files::fixed_text(figures.longest_delay_ms, 2) + " ms";
}

/// Prints a line of figures a period.
int measure(TopicOptions options, std::string (*line_of)(const TopicFigures&)) {
  std::atomic<bool> is_stopped = false;
  const app::StopSignal stop_signal([&] { is_stopped = true; });
  BusView view(options.bus);
  if (const auto fault = watch(view, options)) return *fault;
  TopicMeter& meter = view.topics().at(options.topic).meter;
  const auto period = std::chrono::milliseconds(static_cast<std::int64_t>(options.period_s * 1e3));
  view.receive(100ms, false);  // the endpoints find each other
  meter.reset();
  for (std::uint64_t i = 0; !is_stopped && (options.count == 0 || i < options.count); ++i) {
    const auto begin = std::chrono::steady_clock::now();
    for (auto left = period; left > 0ms && !is_stopped; left -= std::min(left, 100ms))
      view.receive(std::min(left, 100ms), false);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    const TopicFigures figures = meter.figures(elapsed.count());
    std::printf("%s: %zu samples, %s\n", options.topic.c_str(), figures.samples,
                figures.samples == 0 ? "silent" : line_of(figures).c_str());
    std::fflush(stdout);
    meter.reset();
  }
  return kExitDone;
}

CLI::App* add(CLI::App& app, const char* name, const char* purpose, TopicOptions& options) {
  CLI::App* const command = app.add_subcommand(name, purpose);
  add_bus_options(*command, options.bus);
  return command;
}

void add_topic(CLI::App& command, TopicOptions& options, const char* meaning_of_count) {
  command.add_option("topic", options.topic, "Name, with or without slammot/")->required();
  command.add_option("-n,--count", options.count, meaning_of_count)
      ->check(files::not_negative_number());
}

void add_measuring(CLI::App& app, const char* name, const char* purpose, int& exit_code,
                   std::string (*line_of)(const TopicFigures&)) {
  const auto options = std::make_shared<TopicOptions>();
  CLI::App* const command = add(app, name, purpose, *options);
  add_topic(*command, *options, "End after so many lines; default: Ctrl-C ends it");
  command->add_option("--period", options->period_s, "Time of each line [s]")
      ->check(files::number_between(0.1, 3600.0))
      ->capture_default_str();
  command->callback([options, line_of, &exit_code] {
    exit_code = guarded([&] { return measure(*options, line_of); });
  });
}

}  // namespace

void add_list_command(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<TopicOptions>();
  CLI::App* const command = add(app, "list", "List the topics on the bus", *options);
  command->callback([options, &exit_code] { exit_code = guarded([&] { return list(*options); }); });
}

void add_echo_command(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<TopicOptions>();
  CLI::App* const command = add(app, "echo", "Print the samples of a topic of any type", *options);
  add_topic(*command, *options, "End after so many samples; default: Ctrl-C ends it");
  command->add_flag("--full", options->is_full, "All elements of lists, not only the first ten");
  command->callback([options, &exit_code] { exit_code = guarded([&] { return echo(*options); }); });
}

void add_hz_command(CLI::App& app, int& exit_code) {
  add_measuring(app, "hz", "Measure the rate and the size of a topic", exit_code, rate_line);
}

void add_delay_command(CLI::App& app, int& exit_code) {
  add_measuring(app, "delay",
                "Measure the time from writing to reception, by the clocks of both computers",
                exit_code, delay_line);
}

}  // namespace slammot::inspector
