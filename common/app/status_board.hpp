#pragma once

#include <cstdint>
#include <list>
#include <map>
#include <string>
#include <vector>

#include "common/app/input_watch.hpp"
#include "common/app/latency_histogram.hpp"
#include "common/wire/service.hpp"

namespace slammot::app {

using wire::ServiceState;

/// Counters, latencies and faults of a service. For the loop's thread only. References stay valid.
class StatusBoard {
 public:
  static constexpr std::chrono::seconds kPatience{2};

  /// Counter with a name of at most 48 characters; starts at 0.
  std::uint64_t& counter(const std::string& name) { return counters_[name]; }
  /// Counters of an algorithm, which counts itself.
  void set_counters(const std::map<std::string, std::uint64_t>& totals);
  LatencyHistogram& latency(const std::string& stage) { return latencies_[stage]; }
  InputWatch& input(const std::string& topic_name, Input kind, SteadyTime now);

  /// Sets a fault text; the service is degraded until it is cleared.
  void set_trouble(const std::string& what, const std::string& words) { troubles_[what] = words; }
  void clear_trouble(const std::string& what) { troubles_.erase(what); }

  /// The service is not ready, although its process runs: sources of scans wait for it.
  void set_starting(bool is_starting) { is_starting_ = is_starting; }

  /// Starting until the service is ready; then running, or degraded if an input is missing or there
  /// is a fault.
  ServiceState state(SteadyTime now) const {
    if (is_starting_) return ServiceState::kStarting;
    return explanation(now).empty() ? ServiceState::kRunning : ServiceState::kDegraded;
  }
  /// Reason of a degraded state; otherwise empty.
  std::string explanation(SteadyTime now) const;
  std::vector<const InputWatch*> missing_inputs(SteadyTime now) const;

  const std::map<std::string, std::uint64_t>& counters() const { return counters_; }
  const std::map<std::string, LatencyHistogram>& latencies() const { return latencies_; }

 private:
  std::map<std::string, std::uint64_t> counters_;
  std::map<std::string, LatencyHistogram> latencies_;
  std::list<InputWatch> inputs_;
  std::map<std::string, std::string> troubles_;
  bool is_starting_ = false;
};

}  // namespace slammot::app
