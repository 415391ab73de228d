#pragma once

#include <cstdint>

#include "common/app/status_board.hpp"
#include "common/dds/writer.hpp"
#include "common/wire/service.hpp"

namespace slammot::app {

/// Publishes a service's heartbeats and status from the working thread, so that a hung thread falls
/// silent.
class StatusPublisher {
 public:
  static constexpr std::chrono::milliseconds kHeartbeatPeriod{200};
  static constexpr std::chrono::seconds kStatusPeriod{1};

  StatusPublisher(const dds::Participant& participant, wire::ServiceName name);

  /// Place among the processes of one service and vehicle: sent with each heartbeat and status.
  struct Role {
    bool stands_by = false;
    std::uint32_t term = 0;
  };
  void set_role(const Role& role) { role_ = role; }
  std::int64_t started_ns() const { return started_ns_; }

  void beat(ServiceState state);
  /// With the current state and explanation, or `state` when stopping.
  void report(const StatusBoard& board, ServiceState state);
  /// Waits until all readers have the last status, or until the time-out: unsent data is lost when
  /// the writer is deleted.
  void wait_until_heard(std::chrono::milliseconds timeout) const {
    statuses_.wait_for_acknowledgements(timeout);
  }

 private:
  wire::ServiceName name_;
  std::int64_t started_ns_;
  std::uint32_t beats_ = 0;
  Role role_;
  dds::Writer<slammot_Heartbeat> heartbeats_;
  dds::Writer<slammot_ServiceStatus> statuses_;
  wire::StatusEncoder encoder_;
};

}  // namespace slammot::app
