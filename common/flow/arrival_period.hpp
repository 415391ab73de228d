#pragma once

#include <algorithm>
#include <cstdint>

namespace slammot::flow {

/// Mean time between the arrivals of a stream of samples, exponentially smoothed over eight.
class ArrivalPeriod {
 public:
  /// A longer gap is a pause and counts as this.
  static constexpr std::int64_t kLongestNs = 1'000'000'000;

  void add(std::int64_t gap_ns) {
    gap_ns = std::min(gap_ns, kLongestNs);
    period_ns_ = period_ns_ == 0 ? gap_ns : period_ns_ + (gap_ns - period_ns_) / 8;
  }

  /// Silence after which the stream has ended: three periods, and at least `least_ns`.
  std::int64_t end_after_ns(std::int64_t least_ns) const {
    return std::max(least_ns, 3 * period_ns_);
  }

 private:
  std::int64_t period_ns_ = 0;  ///< 0: unknown.
};

}  // namespace slammot::flow
