#pragma once

#include <array>
#include <chrono>
#include <cstdint>

namespace slammot::app {

/// Histogram of the durations of one stage's calls. Fixed memory; percentiles are at most 10 % too
/// high.
class LatencyHistogram {
 public:
  void add(std::chrono::nanoseconds duration);

  std::uint64_t count() const { return count_; }
  /// Percentile of the durations at this share, as the upper end of its bucket; 0 without calls.
  double percentile_ms(double share) const;
  double highest_ms() const { return highest_us_ * 1e-3; }

 private:
  /// Bucket 0 ends at 1 µs, each further one 10 % later, the last one after 100 s.
  static constexpr std::size_t kBuckets = 195;
  static constexpr double kGrowth = 1.1;

  std::array<std::uint64_t, kBuckets> calls_{};
  std::uint64_t count_ = 0;
  double highest_us_ = 0.0;
};

/// Adds the time from its construction to its destruction.
class Stopwatch {
 public:
  explicit Stopwatch(LatencyHistogram& histogram) : histogram_(histogram) {}
  ~Stopwatch() { histogram_.add(std::chrono::steady_clock::now() - start_); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  LatencyHistogram& histogram_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace slammot::app
