#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/wire/service.hpp"

namespace slammot::gateway {

/// What the services of one vehicle last said of themselves.
class ServiceBoard {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::seconds kPatience{2};  ///< Without a heartbeat.
  static constexpr std::chrono::minutes kForgotten{10};

  struct Entry {
    std::string service;
    std::string instance;
    wire::ServiceState state = wire::ServiceState::kStarting;
    Time last_beat;
    std::int64_t started_ns = 0;
    std::uint32_t process_number = 0;
    std::optional<wire::ServiceStatus> status;

    bool is_silent(Time now) const { return now - last_beat > kPatience; }
  };

  void take(const wire::Heartbeat& heartbeat, Time now);
  void take(const wire::ServiceStatus& status, Time now);
  /// Removes services that stopped or fell silent long ago.
  void forget(Time now);

  std::vector<Entry> entries() const;

  /// In words, for people: "tracking: no sign of life for 5 s".
  std::vector<std::string> warnings(Time now) const;

 private:
  void forget_earlier_role_of(const Entry& entry);

  using Key = std::pair<std::string, std::string>;  ///< Service and instance.
  std::map<Key, Entry> entries_;
};

struct GatewayFigures {
  std::uint64_t viewers = 0;
  std::uint64_t dropped_messages = 0;
  std::uint64_t sent_bytes = 0;
  double memory_mb = 0.0;
  double scan_age_s = -1.0;  ///< Since the last localized scan; negative: none came.
};

/// State, counters, latencies and warnings as JSON.
std::string health_json(const ServiceBoard& board, const GatewayFigures& figures,
                        ServiceBoard::Time now);

/// Resident memory of this process.
double resident_memory_mb();

}  // namespace slammot::gateway
