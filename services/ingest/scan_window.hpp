#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>

namespace slammot::ingest {

/// Flow control: how many scans may be on their way through localization, detection and tracking at
/// once, and when what is on its way has to be sent again because some service that had it died.
///
/// Acknowledgements are cumulative: whoever answers for a scan has done with all before it. Time is
/// a parameter.
class ScanWindow {
 public:
  using Time = std::chrono::steady_clock::time_point;

  struct Limits {
    std::size_t most_in_flight = 1;
    std::chrono::nanoseconds resend_after{1'000'000'000};
    int most_sendings = 5;  ///< Then a scan is given up.
  };
  explicit ScanWindow(const Limits& limits) : limits_(limits) {}

  bool has_room() const { return in_flight_.size() < limits_.most_in_flight; }
  bool is_empty() const { return in_flight_.empty(); }

  void sent(std::int64_t stamp_ns, Time now);

  /// All scans up to this stamp have been done with. Returns how many of those in flight these
  /// were.
  std::size_t acknowledge(std::int64_t stamp_ns, Time now);

  /// Whether what is in flight should be sent again now: no progress for resend_after.
  bool is_overdue(Time now) const {
    return !in_flight_.empty() && now - last_progress_ >= limits_.resend_after;
  }

  /// To be called when is_overdue(): forgets scans that were sent often enough and counts the
  /// others as sent again. Returns how many were forgotten; they are the first ones.
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
