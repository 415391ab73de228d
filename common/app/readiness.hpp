#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/wire/service.hpp"

namespace slammot::app {

class ServiceContext;

/// Tracks by heartbeats which services of a drive are running.
class Readiness {
 public:
  explicit Readiness(const std::vector<std::string>& services) {
    for (const std::string& service : services) at_work_[service] = false;
  }

  void heard(const std::string& service, bool is_at_work) {
    const auto known = at_work_.find(service);
    if (known != at_work_.end()) known->second = is_at_work;
  }

  /// Names of missing services, such as "detection, tracking"; empty if all are running.
  std::string missing() const {
    std::string names;
    for (const auto& [service, is_at_work] : at_work_) {
      if (!is_at_work) names += (names.empty() ? "" : ", ") + service;
    }
    return names;
  }

  /// True a moment after the first call: services that run may not have found each other on the bus
  /// yet, and what they send until then is lost.
  bool have_met(std::chrono::steady_clock::time_point now) {
    constexpr std::chrono::milliseconds kTimeToMeet{300};
    if (!all_run_since_) all_run_since_ = now;
    return now - *all_run_since_ >= kTimeToMeet;
  }

 private:
  std::map<std::string, bool> at_work_;
  std::optional<std::chrono::steady_clock::time_point> all_run_since_;
};

/// Takes a heartbeat; that of a standby does not count. True if its service is starting, which
/// announces that it will be ready.
bool take(const slammot_Heartbeat& beat, Readiness& readiness);

/// True if a source of scans may start: all services run and have met, and its topic has a reader,
/// or its patience has ended. Its status reports what it waits for or lacks.
bool may_begin(ServiceContext& context, Readiness& readiness, std::string_view topic, bool is_read,
               bool is_patient);

}  // namespace slammot::app
