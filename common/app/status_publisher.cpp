#include "common/app/status_publisher.hpp"

#include <vector>

#include <unistd.h>

#include "common/app/bounded_text.hpp"
#include "common/app/version.hpp"

namespace slammot::app {
namespace {

std::int64_t system_clock_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

slammot_ServiceState on_the_bus(ServiceState state) { return static_cast<slammot_ServiceState>(state); }

template <typename Sample>
void identify(const ServiceIdentity& identity, Sample& sample) {
  copy_text(identity.vehicle_id, sample.vehicle_id);
  copy_text(identity.service, sample.service_name);
  copy_text(identity.instance, sample.instance_name);
  sample.stamp_ns = system_clock_ns();
}

std::vector<slammot_MissingInput> missing_inputs(const StatusBoard& board, SteadyTime now) {
  std::vector<slammot_MissingInput> missing;
  for (const InputWatch* input : board.missing_inputs(now)) {
    slammot_MissingInput& one = missing.emplace_back();
    copy_text(input->topic_name(), one.topic_name);
    one.silent_s = input->silent_s(now);
  }
  return missing;
}

std::vector<slammot_Counter> counters(const StatusBoard& board) {
  std::vector<slammot_Counter> counters;
  for (const auto& [name, total] : board.counters()) {
    slammot_Counter& one = counters.emplace_back();
    copy_text(name, one.counter_name);
    one.total = total;
  }
  return counters;
}

std::vector<slammot_StageLatency> latencies(const StatusBoard& board) {
  std::vector<slammot_StageLatency> latencies;
  for (const auto& [stage, histogram] : board.latencies()) {
    slammot_StageLatency& one = latencies.emplace_back();
    copy_text(stage, one.stage_name);
    one.call_count = histogram.count();
    one.p50_ms = histogram.percentile_ms(0.50);
    one.p99_ms = histogram.percentile_ms(0.99);
    one.highest_ms = histogram.highest_ms();
  }
  return latencies;
}

/// Lends the vector's elements to a sequence of the bus for as long as the vector lives; at most `most` of them.
template <typename Sequence, typename Element>
void lend(std::vector<Element>& elements, std::size_t most, Sequence& sequence) {
  sequence._length = sequence._maximum = static_cast<std::uint32_t>(std::min(elements.size(), most));
  sequence._buffer = elements.data();
  sequence._release = false;
}

}  // namespace

StatusPublisher::StatusPublisher(const dds::Participant& participant, ServiceIdentity identity)
    : identity_(std::move(identity)),
      started_ns_(system_clock_ns()),
      heartbeats_(participant, dds::topics::kHeartbeat),
      statuses_(participant, dds::topics::kStatus) {}

void StatusPublisher::beat(ServiceState state) {
  slammot_Heartbeat beat{};
  identify(identity_, beat);
  beat.sequence_number = beats_++;
  beat.process_number = static_cast<std::uint32_t>(::getpid());
  beat.state = on_the_bus(state);
  heartbeats_.write(beat);
}

void StatusPublisher::report(const StatusBoard& board, ServiceState state) {
  const SteadyTime now = std::chrono::steady_clock::now();
  slammot_ServiceStatus status{};
  identify(identity_, status);
  status.started_ns = started_ns_;
  copy_text(kVersion, status.version_text);
  status.state = on_the_bus(state);
  copy_text(board.explanation(now), status.explanation);
  std::vector<slammot_MissingInput> missing = missing_inputs(board, now);
  std::vector<slammot_Counter> counts = counters(board);
  std::vector<slammot_StageLatency> stages = latencies(board);
  constexpr std::size_t kMostMissing = 32, kMostCounters = 128, kMostStages = 32;  // bounds in idl/service.idl
  lend(missing, kMostMissing, status.missing_inputs);
  lend(counts, kMostCounters, status.counters);
  lend(stages, kMostStages, status.stage_latencies);
  statuses_.write(status);
}

}  // namespace slammot::app
