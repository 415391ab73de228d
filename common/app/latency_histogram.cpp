#include "common/app/latency_histogram.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::app {

void LatencyHistogram::add(std::chrono::nanoseconds duration) {
  const double us = static_cast<double>(duration.count()) * 1e-3;
  const double bucket = us <= 1.0 ? 0.0 : std::ceil(std::log(us) / std::log(kGrowth));
  ++calls_[std::min(static_cast<std::size_t>(bucket), kBuckets - 1)];
  ++count_;
  highest_us_ = std::max(highest_us_, us);
}

double LatencyHistogram::percentile_ms(double share) const {
  if (count_ == 0) return 0.0;
  const double enough = share * static_cast<double>(count_);
  std::uint64_t so_far = 0;
  std::size_t bucket = 0;
  for (; bucket < kBuckets - 1; ++bucket) {
    so_far += calls_[bucket];
    if (static_cast<double>(so_far) >= enough) break;
  }
  return std::min(std::pow(kGrowth, static_cast<double>(bucket)), highest_us_) * 1e-3;
}

}  // namespace slammot::app
