#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace slammot::app {

class ServiceContext;

/// Which of the services that a drive needs are at work, by their heartbeats.
class Readiness {
 public:
  explicit Readiness(const std::vector<std::string>& services) {
    for (const std::string& service : services) at_work_[service] = false;
  }

  void heard(const std::string& service, bool is_at_work) {
    const auto known = at_work_.find(service);
    if (known != at_work_.end()) known->second = is_at_work;
  }

  /// "detection, tracking"; empty when all are at work.
  std::string missing() const {
    std::string names;
    for (const auto& [service, is_at_work] : at_work_) {
      if (!is_at_work) names += (names.empty() ? "" : ", ") + service;
    }
    return names;
  }

 private:
  std::map<std::string, bool> at_work_;
};

/// Whether a source of scans may begin: everybody is at work and its topic is read, or it is no longer patient. What it
/// waits for, or begins without, is said in its status.
bool may_begin(ServiceContext& context, const Readiness& readiness, std::string_view topic, bool is_read, bool is_patient);

}  // namespace slammot::app
