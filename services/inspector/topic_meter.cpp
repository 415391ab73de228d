#include "services/inspector/topic_meter.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::inspector {
namespace {

/// The smallest value that so large a share of them does not exceed; 0 without values.
double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(rank == 0 ? 0 : rank - 1);
  std::ranges::nth_element(values, nth);
  return *nth;
}

double sigma(const std::vector<double>& values) {
  if (values.empty()) return 0.0;
  double sum = 0.0, squares = 0.0;
  for (const double value : values) sum += value;
  const double mean = sum / static_cast<double>(values.size());
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size()));
}

}  // namespace

void TopicMeter::add(std::int64_t source_time_ns, std::int64_t reception_time_ns,
                     std::size_t bytes) {
  delays_ms_.push_back(static_cast<double>(reception_time_ns - source_time_ns) * 1e-6);
  if (last_ns_ != 0) gaps_ms_.push_back(static_cast<double>(reception_time_ns - last_ns_) * 1e-6);
  last_ns_ = reception_time_ns;
  bytes_ += bytes;
  ++total_;
}

TopicFigures TopicMeter::figures(double interval_s) const {
  TopicFigures figures;
  figures.samples = delays_ms_.size();
  if (figures.samples == 0) return figures;
  const auto count = static_cast<double>(figures.samples);
  figures.rate_hz = interval_s > 0.0 ? count / interval_s : 0.0;
  figures.mean_bytes = static_cast<double>(bytes_) / count;
  if (!gaps_ms_.empty()) {
    figures.shortest_gap_ms = std::ranges::min(gaps_ms_);
    figures.longest_gap_ms = std::ranges::max(gaps_ms_);
    figures.gap_sigma_ms = sigma(gaps_ms_);
  }
  figures.delay_p50_ms = percentile(delays_ms_, 0.50);
  figures.delay_p99_ms = percentile(delays_ms_, 0.99);
  figures.longest_delay_ms = std::ranges::max(delays_ms_);
  return figures;
}

void TopicMeter::reset() {
  delays_ms_.clear();
  gaps_ms_.clear();
  bytes_ = 0;
}

}  // namespace slammot::inspector
