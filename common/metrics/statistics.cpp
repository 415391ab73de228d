#include "common/metrics/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace slammot::metrics {
namespace {

double quantile_of_sorted(const std::vector<double>& sorted, double share) {
  const double position = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], position - static_cast<double>(below));
}

}  // namespace

ErrorSummary summarize(std::vector<double> errors) {
  ErrorSummary summary;
  if (errors.empty()) return summary;
  std::sort(errors.begin(), errors.end());
  const auto count = static_cast<double>(errors.size());
  summary.count = errors.size();
  summary.rmse =
      std::sqrt(std::inner_product(errors.begin(), errors.end(), errors.begin(), 0.0) / count);
  summary.mean = std::accumulate(errors.begin(), errors.end(), 0.0) / count;
  summary.median = quantile_of_sorted(errors, 0.5);
  summary.p95 = quantile_of_sorted(errors, 0.95);
  summary.max = errors.back();
  return summary;
}

}  // namespace slammot::metrics
