#include "common/metrics/nees.hpp"

#include <numeric>

#include "common/metrics/chi_square.hpp"

namespace slammot::metrics {

NeesSummary summarize_nees(const std::vector<double>& samples, int degrees_of_freedom,
                           double probability) {
  NeesSummary summary;
  summary.samples = samples.size();
  summary.degrees_of_freedom = degrees_of_freedom;
  if (samples.empty()) return summary;
  const auto count = static_cast<double>(samples.size());
  const double tail = 0.5 * (1.0 - probability);
  summary.mean = std::accumulate(samples.begin(), samples.end(), 0.0) / count;
  summary.band_low = chi_square_quantile(tail, count * degrees_of_freedom) / count;
  summary.band_high = chi_square_quantile(1.0 - tail, count * degrees_of_freedom) / count;
  return summary;
}

}  // namespace slammot::metrics
