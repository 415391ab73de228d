#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>

namespace slammot::ingest {

/// Flow control: limits the number of scans in processing by localization, detection and tracking,
/// and decides when to send them again because a service died. Acknowledgements are cumulative: an
/// answer to a scan acknowledges all earlier ones. Time is a parameter.
class ScanWindow {
 public:
  using Time = std::chrono::steady_clock::time_point;

  struct Limits {
    std::size_t most_in_flight = 1;
    std::chrono::nanoseconds resend_after{1'000'000'000};
    int max_sendings = 5;  ///< A scan is then given up.
  };
  explicit ScanWindow(const Limits& limits) : limits_(limits) {}

  bool has_room() const { return in_flight_.size() < limits_.most_in_flight; }
  bool is_empty() const { return in_flight_.empty(); }

  void sent(std::int64_t stamp_ns, Time now);

  /// Acknowledges all scans up to this stamp. Returns the number of pending scans among them.
  std::size_t acknowledge(std::int64_t stamp_ns, Time now);

  /// True if there was no progress for resend_after: pending scans should be sent again.
  bool is_overdue(Time now) const {
    return !in_flight_.empty() && now - last_progress_ >= limits_.resend_after;
  }

  /// Call if is_overdue(): drops scans that were sent most_sendings times and counts the others as
  /// sent again. Returns the number of dropped scans, which are the oldest.
  std::size_t resend(Time now);

 private:
  struct Scan {
    std::int64_t stamp_ns;
    int sendings;
  };
  Limits limits_;
  std::deque<Scan> in_flight_;  ///< Ascending.
  Time last_progress_{};
};

}  // namespace slammot::ingest
