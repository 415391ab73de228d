#pragma once

#include <cstdint>

#include "common/app/status_board.hpp"
#include "common/dds/writer.hpp"
#include "common/wire/service.hpp"

namespace slammot::app {

/// Puts a service's heartbeats and its status on the bus. Called in the thread that does the work, so that a hung one
/// falls silent.
class StatusPublisher {
 public:
  static constexpr std::chrono::milliseconds kHeartbeatPeriod{200};
  static constexpr std::chrono::seconds kStatusPeriod{1};

  StatusPublisher(const dds::Participant& participant, wire::ServiceName name);

  void beat(ServiceState state);
  /// With the state and explanation as they are now, or `state` when stopping.
  void report(const StatusBoard& board, ServiceState state);
  /// Waits until everybody has the last status, or the time is over: what is not sent when the writer goes is lost.
  void wait_until_heard(std::chrono::milliseconds timeout) const { statuses_.wait_for_acknowledgements(timeout); }

 private:
  wire::ServiceName name_;
  std::int64_t started_ns_;
  std::uint32_t beats_ = 0;
  dds::Writer<slammot_Heartbeat> heartbeats_;
  dds::Writer<slammot_ServiceStatus> statuses_;
  wire::StatusEncoder encoder_;
};

}  // namespace slammot::app
