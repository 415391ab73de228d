#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

#include "common/app/input_watch.hpp"

namespace slammot::app {

/// A request to stop that may wait for a good moment, for a bounded time.
class StopRequest {
 public:
  /// Three scans of the slowest scanner that drives: one of them brings a good moment.
  static constexpr std::chrono::milliseconds kLongestWait{100};

  /// From any thread. A later one does not wait longer.
  void make(SteadyTime now) {
    std::int64_t none = kNone;
    made_.compare_exchange_strong(none, now.time_since_epoch().count());
  }

  bool is_made() const { return made_ != kNone; }
  bool is_overdue(SteadyTime now) const {
    return is_made() && now - SteadyTime(SteadyTime::duration(made_)) >= kLongestWait;
  }

 private:
  static constexpr std::int64_t kNone = -1;

  std::atomic<std::int64_t> made_ = kNone;  ///< Of the steady clock.
};

}  // namespace slammot::app
