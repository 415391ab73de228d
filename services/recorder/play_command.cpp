#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>
#include <thread>

#include <CLI/CLI.hpp>

#include "common/app/run_service.hpp"
#include "common/app/service_options.hpp"
#include "common/app/stop_signal.hpp"
#include "common/dds/exit_watchdog.hpp"
#include "services/recorder/player.hpp"
#include "services/recorder/record_command.hpp"

namespace slammot::recorder {
namespace {

using namespace std::chrono_literals;

/// Others find the writers within this time: 1 s of discovery (common/dds/config.hpp) and a margin.
constexpr double kDiscovery_s = 1.5;
constexpr auto kPatience = 2s;

struct PlayOptions {
  std::string file;
  std::string speed = "1";
  double from_s = 0.0;
  double duration_s = 0.0;
  double wait_s = kDiscovery_s;
  bool loops = false;
  std::vector<std::string> topics;
  std::uint32_t domain_id = 0;
};

int fail(const std::string& line) {
  std::fprintf(stderr, "slammot: %s\n", line.c_str());
  return app::kExitFailure;
}

std::int64_t ns_of(double seconds) { return static_cast<std::int64_t>(seconds * 1e9); }

void wait(double seconds, const std::atomic<bool>& is_stopped) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::nanoseconds(ns_of(seconds));
  while (!is_stopped && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(10ms);
}

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

int play(const PlayOptions& options) {
  const auto file = mcap::File::open(options.file);
  if (!file) return fail(file.error().message);
  const auto pace = app::Pace::parse(options.speed);
  if (!pace) return fail("--speed is max or a number from 0.01 to 1000, not " + options.speed);
  std::atomic<bool> is_stopped = false;
  dds::ExitWatchdog watchdog;
  const app::StopSignal stop_signal([&] { is_stopped = true; });
  const dds::Participant participant(
      {.domain_id = options.domain_id, .name = "slammot-player", .config = std::nullopt});
  Player player(participant, *file, TopicSelection(options.topics));
  for (const std::string& topic : player.unplayable())
    std::fprintf(stderr, "slammot: %s was not recorded from this bus: left out\n", topic.c_str());
  if (player.topic_count() == 0) return fail(options.file + ": no topic that can be played");
  wait(options.wait_s, is_stopped);
  const std::int64_t from_ns = file->contents().statistics.start_ns + ns_of(options.from_s);
  const std::int64_t to_ns = options.duration_s > 0.0 ? from_ns + ns_of(options.duration_s)
                                                      : std::numeric_limits<std::int64_t>::max();
  do { player.play(from_ns, to_ns, *pace, is_stopped); } while (options.loops && !is_stopped);
  player.wait_for_acknowledgements(kPatience);
  watchdog.arm();
  return report(player, *file);
}

int play_or_fail(const PlayOptions& options) {
  try {
    return play(options);
  } catch (const std::runtime_error& fault) { return fail(fault.what()); }
}

}  // namespace

void add_play_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "play", "Play a recording onto the bus: the same bytes, source times and QoS");
  const auto options = std::make_shared<PlayOptions>();
  command->add_option("file", options->file, "Recording")->required()->type_name("FILE");
  command->add_option("--speed", options->speed, "Multiple of the recorded speed, or max")
      ->capture_default_str();
  command
      ->add_option("--from", options->from_s, "Begin so many seconds after the recording's start")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command
      ->add_option("--duration", options->duration_s, "End after so many recorded seconds; 0: all")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_flag("--loop", options->loops, "Begin again at the end, until Ctrl-C");
  command
      ->add_option("--topics", options->topics,
                   "Topics to play, comma-separated; all by default. A trailing '*' stands for all "
                   "that begin like it")
      ->type_name("NAME,...")
      ->delimiter(',');
  command
      ->add_option("--wait", options->wait_s,
                   "Seconds before the first message, for readers to join")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app::add_domain_option(*command, options->domain_id);
  command->callback([options, &exit_code] { exit_code = play_or_fail(*options); });
}

}  // namespace slammot::recorder
