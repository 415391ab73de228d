#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "common/app/command.hpp"
#include "common/app/log.hpp"
#include "common/app/owner_watch.hpp"
#include "common/app/queue_watch.hpp"
#include "common/app/sequence_watch.hpp"
#include "common/app/service_options.hpp"
#include "common/app/status_board.hpp"
#include "common/app/status_publisher.hpp"
#include "common/app/stop_request.hpp"
#include "common/dds/participant.hpp"
#include "common/dds/reader.hpp"
#include "common/dds/wait_set.hpp"
#include "common/dds/writer.hpp"

namespace slammot::app {

class ServiceContext;

/// Keeps to the writer that a key of a topic has, and counts and reports the samples of others.
class ForeignSamples {
 public:
  ForeignSamples(const dds::TopicInfo& topic, const dds::ReaderBase& reader)
      : topic_(topic.name), reader_(reader) {}
  bool accepts(ServiceContext& context, const dds::SampleInfo& info);
  /// The key lost its last writer.
  void lost(const dds::SampleInfo& info) { owners_.release(info.key_handle); }

 private:
  std::string topic_;
  const dds::ReaderBase& reader_;
  OwnerWatch owners_;
  std::optional<SteadyTime> told_;
};

/// Environment of a service: bus, loop and status. A service registers its readers, writers and
/// timers in its constructor; all callbacks run in the thread that calls run().
class ServiceContext {
 public:
  ServiceContext(const std::string& service, const ServiceOptions& options);
  ServiceContext(const ServiceContext&) = delete;
  ServiceContext& operator=(const ServiceContext&) = delete;

  const ServiceOptions& options() const { return options_; }
  const std::string& service() const { return service_; }
  const std::string& vehicle_id() const { return options_.vehicle_id; }
  const dds::Participant& participant() const { return participant_; }
  StatusBoard& status() { return board_; }

  /// Calls handle(sample), or handle(sample, info), for every sample of this vehicle. The reader
  /// lives as long as the context.
  template <typename Sample, typename Handle>
  dds::Reader<Sample>& read(const dds::Topic<Sample>& topic, Input kind, Handle handle,
                            dds::History history = dds::History::kProfile) {
    auto reader = take<dds::Reader<Sample>>(topic, prepared_readers_);
    if (!reader) reader = std::make_shared<dds::Reader<Sample>>(participant_, topic, history);
    InputWatch& input =
        board_.input(std::string(topic.name), kind, std::chrono::steady_clock::now());
    const auto owners =
        dds::has_one_writer(topic) ? std::make_shared<ForeignSamples>(topic, *reader) : nullptr;
    const bool has_deep_history = history == dds::History::kRestart;
    wait_set_.on_data(*reader, [this, reader = reader.get(), &input, handle, owners,
                                has_deep_history, sequence = SequenceWatch(), queue = QueueWatch(),
                                cut = std::uint64_t{0}]() mutable {
      const auto take = [&](const Sample& sample, const dds::SampleInfo& info) {
        if (vehicle_id() != sample.vehicle_id) return;
        if (owners && !owners->accepts(*this, info)) return;
        if constexpr (IsNumberedScan<Sample>)
          count_missed(input, sequence.missed_before(sample.scanner_id, sample.sequence_number));
        input.came(std::chrono::steady_clock::now());
        if constexpr (std::is_invocable_v<Handle&, const Sample&, const dds::SampleInfo&>)
          handle(sample, info);
        else handle(sample);
      };
      const auto lose = [&](const dds::SampleInfo& info) {
        if (owners) owners->lost(info);
      };
      if (!has_deep_history) reader->take_each(take, lose);
      else  // not all at once: heartbeats are sent meanwhile
        reader->take_batch(take, lose, [&](bool is_long) {
          return queue.leaves_out(is_long, std::chrono::steady_clock::now());
        });
      warn_of_cut_samples(*reader, cut);
    });
    keep(reader);
    return *reader;
  }

  /// Opens the reader that read() of this topic will use: what a standby will need is here when it
  /// takes over, and need not come from the bus.
  template <typename Sample>
  void prepare(const dds::Topic<Sample>& topic, dds::History history) {
    prepared_readers_[std::string(topic.name)] =
        std::make_shared<dds::Reader<Sample>>(participant_, topic, history);
  }

  /// Opens the writer that write() of this topic will use: readers know a standby's before it takes
  /// over, and need not find it then.
  template <typename Sample>
  void prepare_to_write(const dds::Topic<Sample>& topic) {
    refuse_unless_publisher(topic);
    prepared_writers_[std::string(topic.name)] =
        std::make_shared<dds::Writer<Sample>>(participant_, topic);
  }

  /// Calls handle(sample) for what came of a prepared topic meanwhile, the last ones, and closes
  /// it.
  template <typename Sample, typename Handle>
  void take_up(const dds::Topic<Sample>& topic, Handle handle) {
    const auto reader = take<dds::Reader<Sample>>(topic, prepared_readers_);
    if (!reader) return;
    reader->take_each([&](const Sample& sample) {
      if (vehicle_id() == sample.vehicle_id) handle(sample);
    });
  }

  /// The writer lives as long as the context. Throws std::logic_error if the topic table does not
  /// name this service as a publisher: the permissions of identities are made from it.
  template <typename Sample>
  dds::Writer<Sample>& write(const dds::Topic<Sample>& topic) {
    refuse_unless_publisher(topic);
    auto writer = take<dds::Writer<Sample>>(topic, prepared_writers_);
    if (!writer) writer = std::make_shared<dds::Writer<Sample>>(participant_, topic);
    keep(writer);
    hand_over_.push_back([writer = writer.get()] { writer->hand_over(); });
    return *writer;
  }

  /// What the bus brings waits so long for what follows it, and is handled together. For a service
  /// that is not on the way of a scan: it then works when those are done with it.
  void gather_for(std::chrono::nanoseconds duration) { wait_set_.gather_for(duration); }

  /// Registers a periodic callback, first due one period from now. Missed calls are skipped.
  void every(std::chrono::nanoseconds period, std::function<void()> work);
  /// Registers a single callback after `delay`.
  void after(std::chrono::nanoseconds delay, std::function<void()> work);
  /// Registers a callback before each status, to update counters.
  void before_report(std::function<void()> work) { before_report_.push_back(std::move(work)); }
  void on_command(const std::string& verb, CommandDesk::Handler handler) {
    desk_.on(verb, std::move(handler));
  }

  /// Counts under `counter` and warns at a limited rate.
  void warn(const std::string& counter, std::string_view line);

  /// Adds the time since the scan was published to the latencies of a stage (scan_latency.hpp).
  void note_since_scan(const std::string& stage, std::int64_t scan_published_ns);

  /// Ends run(), from any thread.
  void stop() { wait_set_.stop(); }
  /// The same with an exit code of the process. Call it from the loop's thread.
  void stop(int exit_code);
  int exit_code() const { return exit_code_; }

  /// As stop(), but a service that stops between scans goes on until the next of its moments, for
  /// at most StopRequest::kLongestWait. From any thread.
  void request_stop();
  /// The service names the moments after a scan at which it hands its state over best: the time
  /// until the next scan is longest. Call it before run().
  void stop_between_scans() { stops_between_scans_ = true; }
  /// Such a moment. Whether it stops.
  bool may_stop_now();

  /// Sends its place among the processes of this service and vehicle with each heartbeat, of which
  /// more are sent from now on: others notice the end of this process by their absence.
  void set_role(const StatusPublisher::Role& role);
  std::int64_t started_ns() const { return publisher_.started_ns(); }

  /// Runs until stopped. Then calls `end`, which ends the service and gives its state free, before
  /// others hear that this process stops: a standby takes over at once.
  void run(const std::function<void()>& end = [] {});
  /// Runs until the condition holds, which is asked every few milliseconds; false if stopped
  /// before.
  bool run_until(const std::function<bool()>& condition);
  /// Runs for about this time, for tests with several services in one thread.
  void run_for(std::chrono::nanoseconds duration);

 private:
  struct Timer {
    SteadyTime due;
    std::optional<std::chrono::nanoseconds> period;
    std::function<void()> work;
  };

  using Endpoints = std::map<std::string, std::shared_ptr<void>>;  ///< By topic.

  template <typename Side>
  static std::shared_ptr<Side> take(const dds::TopicInfo& topic, Endpoints& from) {
    const auto found = from.find(std::string(topic.name));
    if (found == from.end()) return nullptr;
    auto endpoint = std::static_pointer_cast<Side>(std::move(found->second));
    from.erase(found);
    return endpoint;
  }

  template <typename Side>
  void keep(const std::shared_ptr<Side>& endpoint) {
    mismatches_.push_back([side = endpoint.get()] { return side->mismatch(); });
    endpoints_.push_back(endpoint);
  }
  void count_missed(const InputWatch& input, std::uint32_t samples);
  /// Of those since `known`, which is brought up to date.
  void warn_of_cut_samples(const dds::ReaderBase& reader, std::uint64_t& known);
  void refuse_unless_publisher(const dds::TopicInfo& topic) const;
  std::chrono::nanoseconds until_next_timer() const;
  void run_due_timers();
  void beat();
  void say_goodbye();
  void report();
  void report_as(ServiceState state);
  void report_changes(const std::string& explanation);
  void report_mismatches();

  ServiceOptions options_;
  std::string service_;
  dds::Participant participant_;
  dds::WaitSet wait_set_;
  StatusBoard board_;
  StatusPublisher publisher_;
  CommandDesk desk_;
  RateLimit rate_limit_;
  std::vector<std::shared_ptr<void>> endpoints_;
  Endpoints prepared_readers_;
  Endpoints prepared_writers_;
  std::vector<std::function<std::optional<dds::QosMismatch>()>> mismatches_;
  std::vector<std::function<void()>> hand_over_;
  std::uint32_t mismatches_reported_ = 0;
  std::vector<Timer> timers_;
  std::vector<std::function<void()>> before_report_;
  std::string last_explanation_;
  bool has_role_ = false;
  std::atomic<bool> stops_between_scans_ = false;
  StopRequest stop_request_;
  int exit_code_ = 0;
};

}  // namespace slammot::app
