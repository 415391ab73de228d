#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace slammot::inspector {

/// Figures of the samples of one topic in an interval.
struct TopicFigures {
  std::size_t samples = 0;
  double rate_hz = 0.0;
  double mean_bytes = 0.0;
  double shortest_gap_ms = 0.0, longest_gap_ms = 0.0, gap_sigma_ms = 0.0;  ///< Between arrivals.
  /// From writing, by the writer's clock, to arrival, by this computer's.
  double delay_p50_ms = 0.0, delay_p99_ms = 0.0, longest_delay_ms = 0.0;
};

/// Measures the samples of a topic. Times are of the system clock.
class TopicMeter {
 public:
  void add(std::int64_t source_time_ns, std::int64_t reception_time_ns, std::size_t bytes);

  /// Of the samples since the last reset, which came in `interval_s`.
  TopicFigures figures(double interval_s) const;
  /// Begins a new interval; the total and the last arrival stay.
  void reset();

  std::size_t total() const { return total_; }
  /// Since the last arrival; negative if there was none.
  double age_s(std::int64_t now_ns) const {
    return last_ns_ == 0 ? -1.0 : static_cast<double>(now_ns - last_ns_) * 1e-9;
  }

 private:
  std::vector<double> delays_ms_, gaps_ms_;
  std::size_t bytes_ = 0;
  std::size_t total_ = 0;
  std::int64_t last_ns_ = 0;
};

}  // namespace slammot::inspector
