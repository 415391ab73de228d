#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/wire/decoded.hpp"
#include "idl/service.h"

namespace slammot::wire {

/// Which of the processes on the bus this is. Each name at most kLongestName bytes.
struct ServiceName {
  std::string vehicle_id;
  std::string service;   ///< E.g. "detection".
  std::string instance;  ///< Tells several of one kind apart, e.g. by their scanner.
};

enum class ServiceState : std::uint8_t { kStarting, kRunning, kDegraded, kStopping };

std::string_view to_string(ServiceState state);

struct Heartbeat {
  ServiceName name;
  std::int64_t stamp_ns = 0;  ///< System clock.
  std::uint32_t sequence = 0;
  std::uint32_t process_number = 0;
  ServiceState state = ServiceState::kStarting;
  bool stands_by = false;       ///< Another process of the service leads; this one would take over.
  std::uint32_t term = 0;       ///< Grows with each takeover.
  std::int64_t started_ns = 0;  ///< System clock.
};

struct Counter {
  std::string name;
  std::uint64_t total = 0;
};

struct StageLatency {
  std::string stage;
  std::uint64_t calls = 0;
  double p50_ms = 0.0;
  double p99_ms = 0.0;
  double highest_ms = 0.0;
};

struct MissingInput {
  std::string topic;
  double silent_s = 0.0;  ///< Since the last sample; negative: never came.
};

struct ServiceStatus {
  ServiceName name;
  std::int64_t stamp_ns = 0;    ///< System clock.
  std::int64_t started_ns = 0;  ///< System clock.
  std::string version;
  ServiceState state = ServiceState::kStarting;
  std::string explanation;  ///< Of a state other than running; at most 256 bytes travel.
  std::vector<MissingInput> missing_inputs;  ///< At most 32 travel,
  std::vector<Counter> counters;             ///< of these 128,
  std::vector<StageLatency> latencies;       ///< and of these 32.
  std::uint32_t process_number = 0;
  bool stands_by = false;  ///< As in Heartbeat.
};

struct Command {
  std::string vehicle_id;
  std::string service;               ///< Who is asked.
  std::string requester;             ///< Who asks: unique, at most 64 bytes.
  std::uint64_t request_number = 0;  ///< Unique for the requester.
  std::string verb;
  std::string argument;
};

enum class Outcome : std::uint8_t { kDone, kRefused, kUnknownVerb };

struct Reply {
  std::string vehicle_id;
  std::string requester;
  std::uint64_t request_number = 0;
  std::string service;  ///< Who answers.
  Outcome outcome = Outcome::kDone;
  std::string explanation;
};

slammot_Heartbeat encode(const Heartbeat& heartbeat);
slammot_Command encode(const Command& command);
slammot_Reply encode(const Reply& reply);

Decoded<Heartbeat> decode(const slammot_Heartbeat& sample);
Decoded<Command> decode(const slammot_Command& sample);
Decoded<Reply> decode(const slammot_Reply& sample);

/// Puts statuses on the wire; keeps its buffers.
class StatusEncoder {
 public:
  /// The result is good until the next call.
  const slammot_ServiceStatus& encode(const ServiceStatus& status);

 private:
  slammot_ServiceStatus sample_{};
  std::vector<slammot_MissingInput> missing_inputs_;
  std::vector<slammot_Counter> counters_;
  std::vector<slammot_StageLatency> latencies_;
};

Decoded<ServiceStatus> decode(const slammot_ServiceStatus& sample);

}  // namespace slammot::wire
