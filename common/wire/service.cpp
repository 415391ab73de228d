#include "common/wire/service.hpp"

#include <algorithm>

#include "common/wire/parts.hpp"
#include "common/wire/text.hpp"

namespace slammot::wire {
namespace {

constexpr std::size_t kMostMissingInputs = 32;
constexpr std::size_t kMostCounters = 128;
constexpr std::size_t kMostLatencies = 32;

static_assert(static_cast<int>(ServiceState::kStarting) == slammot_SERVICE_STATE_STARTING);
static_assert(static_cast<int>(ServiceState::kRunning) == slammot_SERVICE_STATE_RUNNING);
static_assert(static_cast<int>(ServiceState::kDegraded) == slammot_SERVICE_STATE_DEGRADED);
static_assert(static_cast<int>(ServiceState::kStopping) == slammot_SERVICE_STATE_STOPPING);
static_assert(static_cast<int>(Outcome::kDone) == slammot_OUTCOME_DONE);
static_assert(static_cast<int>(Outcome::kRefused) == slammot_OUTCOME_REFUSED);
static_assert(static_cast<int>(Outcome::kUnknownVerb) == slammot_OUTCOME_UNKNOWN_VERB);

template <typename Sample>
void set_name(Sample& sample, const ServiceName& name) {
  set_text(sample.vehicle_id, name.vehicle_id);
  set_text(sample.service_name, name.service);
  set_text(sample.instance_name, name.instance);
}

template <typename Sample>
ServiceName name_of(const Sample& sample) {
  return {std::string(text(sample.vehicle_id)), std::string(text(sample.service_name)),
          std::string(text(sample.instance_name))};
}

bool is_state(const slammot_ServiceState& state) {
  return is_enumerator(state, slammot_SERVICE_STATE_STOPPING);
}

/// Encodes the first `most` of `from` into `to`, keeping its memory.
template <typename From, typename To, typename Encode>
void encode_some(const std::vector<From>& from, std::size_t most, std::vector<To>& to,
                 Encode encode_one) {
  to.clear();
  for (std::size_t i = 0; i < std::min(most, from.size()); ++i) {
    to.emplace_back();
    encode_one(from[i], to.back());
  }
}

std::string_view fault_of(const slammot_ServiceStatus& sample) {
  if (!is_state(sample.state)) return "state is unknown";
  for (const slammot_MissingInput& input : elements(sample.missing_inputs)) {
    if (!is_sound(input.silent_s)) return "silent_s is not finite";
  }
  for (const slammot_StageLatency& latency : elements(sample.stage_latencies)) {
    if (!is_amount(latency.p50_ms) || !is_amount(latency.p99_ms) ||
        !is_amount(latency.highest_ms)) {
      return "a latency is negative or not finite";
    }
  }
  return "";
}

}  // namespace

std::string_view to_string(ServiceState state) {
  switch (state) {
    case ServiceState::kStarting: return "starting";
    case ServiceState::kRunning: return "running";
    case ServiceState::kDegraded: return "degraded";
    case ServiceState::kStopping: return "stopping";
  }
  return "unknown";
}

slammot_Heartbeat encode(const Heartbeat& heartbeat) {
  slammot_Heartbeat sample{};
  set_name(sample, heartbeat.name);
  sample.stamp_ns = heartbeat.stamp_ns;
  sample.sequence_number = heartbeat.sequence;
  sample.process_number = heartbeat.process_number;
  sample.state = static_cast<slammot_ServiceState>(heartbeat.state);
  sample.stands_by = heartbeat.stands_by;
  sample.term = heartbeat.term;
  sample.started_ns = heartbeat.started_ns;
  return sample;
}

slammot_Command encode(const Command& command) {
  slammot_Command sample{};
  set_text(sample.vehicle_id, command.vehicle_id);
  set_text(sample.service_name, command.service);
  set_text(sample.requester, command.requester);
  sample.request_number = command.request_number;
  set_text(sample.verb, command.verb);
  set_text(sample.argument, command.argument);
  return sample;
}

slammot_Reply encode(const Reply& reply) {
  slammot_Reply sample{};
  set_text(sample.vehicle_id, reply.vehicle_id);
  set_text(sample.requester, reply.requester);
  sample.request_number = reply.request_number;
  set_text(sample.service_name, reply.service);
  sample.result = static_cast<slammot_Outcome>(reply.outcome);
  set_text(sample.explanation, reply.explanation);
  return sample;
}

Decoded<Heartbeat> decode(const slammot_Heartbeat& sample) {
  if (!is_state(sample.state)) return Fault{"state is unknown"};
  return Heartbeat{name_of(sample),
                   sample.stamp_ns,
                   sample.sequence_number,
                   sample.process_number,
                   static_cast<ServiceState>(sample.state),
                   sample.stands_by,
                   sample.term,
                   sample.started_ns};
}

Decoded<Command> decode(const slammot_Command& sample) {
  if (text(sample.verb).empty()) return Fault{"no verb"};
  return Command{std::string(text(sample.vehicle_id)), std::string(text(sample.service_name)),
                 std::string(text(sample.requester)),  sample.request_number,
                 std::string(text(sample.verb)),       std::string(text(sample.argument))};
}

Decoded<Reply> decode(const slammot_Reply& sample) {
  if (!is_enumerator(sample.result, slammot_OUTCOME_UNKNOWN_VERB))
    return Fault{"result is unknown"};
  return Reply{std::string(text(sample.vehicle_id)),
               std::string(text(sample.requester)),
               sample.request_number,
               std::string(text(sample.service_name)),
               static_cast<Outcome>(sample.result),
               std::string(text(sample.explanation))};
}

const slammot_ServiceStatus& StatusEncoder::encode(const ServiceStatus& status) {
  encode_some(status.missing_inputs, kMostMissingInputs, missing_inputs_,
              [](const MissingInput& from, slammot_MissingInput& to) {
                set_text(to.topic_name, from.topic);
                to.silent_s = from.silent_s;
              });
  encode_some(status.counters, kMostCounters, counters_,
              [](const Counter& from, slammot_Counter& to) {
                set_text(to.counter_name, from.name);
                to.total = from.total;
              });
  encode_some(status.latencies, kMostLatencies, latencies_,
              [](const StageLatency& from, slammot_StageLatency& to) {
                set_text(to.stage_name, from.stage);
                to.call_count = from.calls;
                to.p50_ms = from.p50_ms;
                to.p99_ms = from.p99_ms;
                to.highest_ms = from.highest_ms;
              });
  set_name(sample_, status.name);
  sample_.stamp_ns = status.stamp_ns;
  sample_.started_ns = status.started_ns;
  set_text(sample_.version_text, status.version);
  sample_.state = static_cast<slammot_ServiceState>(status.state);
  set_text(sample_.explanation, status.explanation);
  show(sample_.missing_inputs, missing_inputs_);
  show(sample_.counters, counters_);
  show(sample_.stage_latencies, latencies_);
  sample_.process_number = status.process_number;
  sample_.stands_by = status.stands_by;
  return sample_;
}

Decoded<ServiceStatus> decode(const slammot_ServiceStatus& sample) {
  if (const std::string_view fault = fault_of(sample); !fault.empty()) return Fault{fault};
  ServiceStatus status{.name = name_of(sample),
                       .stamp_ns = sample.stamp_ns,
                       .started_ns = sample.started_ns,
                       .version = std::string(text(sample.version_text)),
                       .state = static_cast<ServiceState>(sample.state),
                       .explanation = std::string(text(sample.explanation)),
                       .missing_inputs = {},
                       .counters = {},
                       .latencies = {},
                       .process_number = sample.process_number,
                       .stands_by = sample.stands_by};
  for (const slammot_MissingInput& input : elements(sample.missing_inputs)) {
    status.missing_inputs.push_back({std::string(text(input.topic_name)), input.silent_s});
  }
  for (const slammot_Counter& counter : elements(sample.counters)) {
    status.counters.push_back({std::string(text(counter.counter_name)), counter.total});
  }
  for (const slammot_StageLatency& latency : elements(sample.stage_latencies)) {
    status.latencies.push_back({std::string(text(latency.stage_name)), latency.call_count,
                                latency.p50_ms, latency.p99_ms, latency.highest_ms});
  }
  return status;
}

}  // namespace slammot::wire
