#pragma once

#include <map>
#include <string>
#include <vector>

namespace slammot::app {

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

}  // namespace slammot::app
