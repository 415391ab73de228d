#include "common/app/scan_latency.hpp"

namespace slammot::app {

void add_since_scan(LatencyHistogram& histogram, std::int64_t scan_published_ns,
                    std::int64_t now_ns) {
  constexpr std::int64_t kLongestNs = 10'000'000'000;
  const bool is_known = scan_published_ns > 0 && scan_published_ns <= now_ns;
  if (!is_known || now_ns - scan_published_ns > kLongestNs) return;
  histogram.add(std::chrono::nanoseconds(now_ns - scan_published_ns));
}

}  // namespace slammot::app
