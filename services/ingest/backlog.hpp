#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

#include "services/ingest/log_source.hpp"

namespace slammot::ingest {

/// Back-pressure at a given speed: scans that are due wait here while the services are busy with
/// earlier ones, and the oldest are dropped. Services that are silent are not waited for: a stopped
/// tracking does not stop localization. Time is a parameter.
class Backlog {
 public:
  using Time = std::chrono::steady_clock::time_point;

  struct Limits {
    std::size_t most_in_flight = 4;  ///< As many localized scans as a reader keeps.
    std::chrono::nanoseconds longest_wait{200'000'000};  ///< A scan is then dropped.
    std::chrono::nanoseconds silence{100'000'000};       ///< Without an answer nothing waits.
  };
  explicit Backlog(const Limits& limits) : limits_(limits) {}

  bool empty() const { return waiting_.empty(); }

  void add(Step step, Time now) { waiting_.push_back({std::move(step), now}); }

  /// Drops what has waited too long. Returns the number of scans among it.
  std::size_t drop_late(Time now) {
    std::size_t scans = 0;
    while (!empty() && now - waiting_.front().since > limits_.longest_wait) {
      scans += waiting_.front().step.scan ? 1 : 0;
      waiting_.pop_front();
    }
    return scans;
  }

  bool may_send(Time now) const {
    const bool is_silent = !last_answer_ || now - *last_answer_ > limits_.silence;
    return !empty() && (in_flight_ns_.size() < limits_.most_in_flight || is_silent);
  }

  /// The oldest step, to be sent now. Precondition: may_send().
  Step take() {
    Step step = std::move(waiting_.front().step);
    waiting_.pop_front();
    if (step.scan) in_flight_ns_.push_back(step.scan->stamp_ns);
    if (in_flight_ns_.size() > limits_.most_in_flight) in_flight_ns_.pop_front();
    return step;
  }

  /// An answer to the scan of this stamp, and so to all before it.
  void answered(std::int64_t stamp_ns, Time now) {
    last_answer_ = now;
    while (!in_flight_ns_.empty() && in_flight_ns_.front() <= stamp_ns) in_flight_ns_.pop_front();
  }

 private:
  struct Waiting {
    Step step;
    Time since;
  };

  Limits limits_;
  std::deque<Waiting> waiting_;
  std::deque<std::int64_t> in_flight_ns_;  ///< Stamps of the last scans sent without an answer.
  std::optional<Time> last_answer_;
};

}  // namespace slammot::ingest
