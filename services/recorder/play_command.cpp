#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include <CLI/CLI.hpp>

#include "common/app/log.hpp"
#include "common/app/run_service.hpp"
#include "common/app/service_options.hpp"
#include "common/app/stop_signal.hpp"
#include "common/dds/exit_watchdog.hpp"
#include "common/files/decimal.hpp"
#include "common/files/failure.hpp"
#include "common/files/finite_number.hpp"
#include "common/files/number_option.hpp"
#include "common/recordings/recorded_topic.hpp"
#include "common/wire/service.hpp"
#include "services/recorder/live_services.hpp"
#include "services/recorder/player.hpp"
#include "services/recorder/record_command.hpp"

namespace slammot::recorder {
namespace {

using namespace std::chrono_literals;

/// Others find the writers within this time: 1 s of discovery (common/dds/config.hpp) and a margin.
constexpr double kDiscovery_s = 1.5;
constexpr auto kPatience = 2s;
constexpr double kLongest_s = 1e9;
constexpr double kAsFastAsPossible = std::numeric_limits<double>::infinity();

struct PlayOptions {
  std::string file;
  std::string speed = "1";
  double from_s = 0.0;
  double duration_s = 0.0;
  double wait_s = kDiscovery_s;
  bool loops = false;
  bool lingers = false;
  std::string vehicle_id;
  std::vector<std::string> topics;
  std::uint32_t domain_id = 0;
};

std::int64_t ns_of(double seconds) { return static_cast<std::int64_t>(seconds * 1e9); }

int report(const Player& player, const mcap::File& file) {
  const PlayCounters& counters = player.counters();
  std::printf("%llu messages of %zu topics\n", static_cast<unsigned long long>(counters.played),
              player.topic_count());
  if (counters.malformed > 0)
    std::printf("malformed and left out: %llu\n",
                static_cast<unsigned long long>(counters.malformed));
  if (counters.timed_out > 0)
    std::printf("not sent, because a reader was too slow: %llu\n",
                static_cast<unsigned long long>(counters.timed_out));
  for (const std::string& damage : file.contents().damage)
    std::fprintf(stderr, "slammot: %s\n", damage.c_str());
  return 0;
}

PlayRange range_of(const PlayOptions& options, const mcap::File& file) {
  const std::int64_t from_ns = file.contents().statistics.start_ns + ns_of(options.from_s);
  return {from_ns, options.duration_s > 0.0 ? from_ns + ns_of(options.duration_s)
                                            : std::numeric_limits<std::int64_t>::max()};
}

double length_s(const mcap::File& file) {
  const mcap::Statistics& statistics = file.contents().statistics;
  return static_cast<double>(statistics.end_ns - statistics.start_ns) * 1e-9;
}

std::optional<double> number_in(std::string_view text) {
  const std::optional<double> value = files::finite_number(text);
  return value && std::abs(*value) < kLongest_s ? value : std::nullopt;
}

double speed_of(const std::string& text) { return number_in(text).value_or(kAsFastAsPossible); }

app::CommandResult refused(const char* expected) {
  return {app::CommandOutcome::kRefused, expected};
}

/// Commands of others on the bus, such as the page of the gateway.
void answer_commands(app::ServiceContext& context, PlayControl& control, std::int64_t start_ns) {
  context.on_command("pause", [&control](std::string_view) {
    control.pause();
    return app::CommandResult{};
  });
  context.on_command("go_on", [&control](std::string_view) {
    control.go_on();
    return app::CommandResult{};
  });
  context.on_command("step", [&control](std::string_view argument) {
    const auto seconds = number_in(argument);
    if (!seconds || *seconds <= 0.0) return refused("step takes seconds");
    control.step(ns_of(*seconds));
    return app::CommandResult{};
  });
  context.on_command("seek", [&control, start_ns](std::string_view argument) {
    const auto seconds = number_in(argument);
    if (!seconds || *seconds < 0.0) return refused("seek takes seconds since the start");
    control.seek(start_ns + ns_of(*seconds));
    return app::CommandResult{};
  });
  context.on_command("speed", [&control](std::string_view argument) {
    const std::string text(argument);
    const auto pace = app::Pace::parse(text);
    if (!pace) return refused("speed takes max or a number from 0.01 to 1000");
    control.set_speed(*pace, speed_of(text));
    return app::CommandResult{};
  });
}

/// Where playing is, in the player's status.
void report_position(app::ServiceContext& context, const PlayControl& control,
                     const mcap::Statistics& statistics) {
  const auto ms = [](std::int64_t ns) {
    return static_cast<std::uint64_t>(std::max<std::int64_t>(ns / 1'000'000, 0));
  };
  context.before_report([&context, &control, statistics, ms] {
    const PlayState state = control.state();
    context.status().set_counters(
        {{"position_ms", ms(state.position_ns - statistics.start_ns)},
         {"duration_ms", ms(statistics.end_ns - statistics.start_ns)},
         {"is_paused", state.is_paused ? 1U : 0U},
         {"speed_percent", std::isfinite(state.speed)
                               ? static_cast<std::uint64_t>(std::lround(100.0 * state.speed))
                               : 0U}});
  });
}

/// Calls `refuse` with the reason where a service of the vehicle runs that publishes what is
/// played.
void watch_for_live_services(app::ServiceContext& context, const Player& player,
                             std::function<void(std::string)> refuse) {
  context.read(dds::topics::kHeartbeat, app::Input::kOccasional,
               [&context, &player, played = player.topics(), refuse = std::move(refuse)](
                   const slammot_Heartbeat& sample, const dds::SampleInfo& info) {
                 if (player.has_writer(info.writer_handle)) return;
                 const auto beat = wire::decode(sample);
                 if (!beat || beat->state == wire::ServiceState::kStopping) return;
                 const auto topics = contested_topics(beat->name.service, played);
                 if (topics.empty()) return;
                 refuse(contest(beat->name.service, context.vehicle_id(), topics));
               });
}

/// Plays until the end or a signal, in a thread beside the context's. Returns what went wrong.
std::string play_all(app::ServiceContext& context, const PlayOptions& options,
                     const mcap::File& file, Player& player, PlayControl& control) {
  std::string fault;
  std::jthread playing([&] {
    try {
      PlayRange range = range_of(options, file);
      while (player.play(range, control)) {
        if (options.loops) continue;
        if (!options.lingers || control.await_command() != PlayControl::Turn::kSeek) break;
        range.from_ns = control.take_seek();
      }
    } catch (const std::runtime_error& error) { fault = error.what(); }
    context.stop();
  });
  context.run();
  control.stop();
  playing.join();
  return fault;
}

app::ServiceOptions service_options(const PlayOptions& options, const mcap::File& file) {
  app::ServiceOptions service;
  service.domain_id = options.domain_id;
  const std::string vehicle_id =
      options.vehicle_id.empty() ? recordings::first_vehicle(file) : options.vehicle_id;
  if (!vehicle_id.empty()) service.vehicle_id = vehicle_id;
  return service;
}

int play(const PlayOptions& options) {
  const auto file = mcap::File::open(options.file);
  if (!file) return files::fail(file.error().message);
  PlayControl control(app::Pace::parse(options.speed).value(), speed_of(options.speed));
  dds::ExitWatchdog watchdog;
  app::set_up_log("player");
  app::ServiceContext context("player", service_options(options, *file));
  const app::StopSignal stop_signal([&] {
    control.stop();
    context.stop();
  });
  Player player(context.participant(), *file, TopicSelection(options.topics));
  for (const std::string& topic : player.unplayable())
    std::fprintf(stderr, "slammot: %s was not recorded from this bus: left out\n", topic.c_str());
  if (player.topic_count() == 0) return files::fail(options.file + ": no topic that can be played");
  if (!player.has_message_in(range_of(options, *file)))
    return files::fail(options.file + ": no message to play in that time; the recording is " +
                       files::fixed_text(length_s(*file), 1) + " s long");
  if (options.lingers) player.prepare_seeks();
  answer_commands(context, control, file->contents().statistics.start_ns);
  report_position(context, control, file->contents().statistics);
  std::string fault;
  watch_for_live_services(context, player, [&](std::string reason) {
    fault = std::move(reason);
    control.stop();
    context.stop();
  });
  context.run_for(std::chrono::nanoseconds(ns_of(options.wait_s)));
  const std::string failure =
      fault.empty() ? play_all(context, options, *file, player, control) : "";
  if (!fault.empty() || !failure.empty()) return files::fail(fault.empty() ? failure : fault);
  player.wait_for_acknowledgements(kPatience);
  watchdog.arm();
  return report(player, *file);
}

int play_or_fail(const PlayOptions& options) {
  try {
    return play(options);
  } catch (const std::runtime_error& fault) { return files::fail(fault.what()); }
}

}  // namespace

void add_play_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "play", "Play a recording onto the bus: the same bytes, source times and QoS");
  const auto options = std::make_shared<PlayOptions>();
  command->add_option("file", options->file, "Recording")->required()->type_name("FILE");
  app::add_speed_option(*command, options->speed, "Multiple of the recorded speed, or max");
  command
      ->add_option("--from", options->from_s, "Begin so many seconds after the recording's start")
      ->check(files::seconds_option())
      ->capture_default_str();
  command
      ->add_option("--duration", options->duration_s, "End after so many recorded seconds; 0: all")
      ->check(files::seconds_option())
      ->capture_default_str();
  command->add_flag("--loop", options->loops, "Begin again at the end, until Ctrl-C");
  command->add_flag("--linger", options->lingers,
                    "Stay at the end, for a seek from the page of the gateway");
  command->add_option("--vehicle", options->vehicle_id,
                      "Vehicle whose viewers may pause and seek; default: the first in it");
  command
      ->add_option("--topics", options->topics,
                   "Topics to play, comma-separated; all by default. A trailing '*' stands for all "
                   "that begin like it")
      ->type_name("NAME,...")
      ->delimiter(',');
  command
      ->add_option("--wait", options->wait_s,
                   "Seconds before the first message, for readers to join")
      ->check(files::seconds_option())
      ->capture_default_str();
  app::add_domain_option(*command, options->domain_id);
  command->callback([options, &exit_code] { exit_code = play_or_fail(*options); });
}

}  // namespace slammot::recorder
