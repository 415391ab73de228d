#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace slammot::metrics {

/// Errors of one object at closer times are correlated, and are not samples of their own.
inline constexpr std::int64_t kNeesIntervalNs = 1'000'000'000;

/// Normalized estimation error squared over many samples: Bar-Shalom, Li and Kirubarajan 2001,
/// section 5.4.
struct NeesSummary {
  std::size_t samples = 0;
  int degrees_of_freedom = 0;  ///< Of one sample.
  double mean = 0.0;  ///< degrees_of_freedom for consistent covariances, higher for overconfident
                      ///< ones.
  double band_low = 0.0;  ///< Lower limit of the chi-square band for the mean of this many
                          ///< independent samples.
  double band_high = 0.0;

  bool is_inside() const { return samples > 0 && mean >= band_low && mean <= band_high; }
};

/// Mean of the samples and the two-sided chi-square band of the given probability, in (0, 1), for
/// it.
NeesSummary summarize_nees(const std::vector<double>& samples, int degrees_of_freedom,
                           double probability = 0.95);

}  // namespace slammot::metrics
