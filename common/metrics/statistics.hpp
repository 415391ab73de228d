#pragma once

#include <cstddef>
#include <vector>

namespace slammot::metrics {

/// Statistics of a list of errors; all zero for an empty list.
struct ErrorSummary {
  std::size_t count = 0;
  double rmse = 0.0;
  double mean = 0.0;
  double median = 0.0;  ///< Mean of the two in the middle of an even count.
  double p95 = 0.0;     ///< The value that 95 % do not exceed, by linear interpolation.
  double max = 0.0;
};

/// Errors are absolute values, in any unit.
ErrorSummary summarize(std::vector<double> errors);

}  // namespace slammot::metrics
