#include "common/app/status_publisher.hpp"

#include <unistd.h>

#include "common/app/system_clock.hpp"
#include "common/app/version.hpp"

namespace slammot::app {
namespace {

wire::StageLatency describe(const std::string& stage, const LatencyHistogram& histogram) {
  return {stage, histogram.count(), histogram.percentile_ms(0.50), histogram.percentile_ms(0.99),
          histogram.highest_ms()};
}

}  // namespace

StatusPublisher::StatusPublisher(const dds::Participant& participant, wire::ServiceName name)
    : name_(std::move(name)),
      started_ns_(system_clock_ns()),
      heartbeats_(participant, dds::topics::kHeartbeat),
      statuses_(participant, dds::topics::kStatus) {}

void StatusPublisher::beat(ServiceState state) {
  heartbeats_.write(wire::encode(wire::Heartbeat{name_, system_clock_ns(), beats_++,
                                                 static_cast<std::uint32_t>(::getpid()), state,
                                                 role_.stands_by, role_.term, started_ns_}));
}

void StatusPublisher::report(const StatusBoard& board, ServiceState state) {
  const SteadyTime now = std::chrono::steady_clock::now();
  wire::ServiceStatus status;
  status.name = name_;
  status.stamp_ns = system_clock_ns();
  status.started_ns = started_ns_;
  status.version = kVersion;
  status.state = state;
  status.explanation = board.explanation(now);
  for (const InputWatch* input : board.missing_inputs(now))
    status.missing_inputs.push_back({input->topic_name(), input->silent_s(now)});
  for (const auto& [name, total] : board.counters()) status.counters.push_back({name, total});
  for (const auto& [stage, histogram] : board.latencies())
    status.latencies.push_back(describe(stage, histogram));
  status.process_number = static_cast<std::uint32_t>(::getpid());
  status.stands_by = role_.stands_by;
  statuses_.write(encoder_.encode(status));
}

}  // namespace slammot::app
