#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace slammot::testing {

/// The value that a share of them do not exceed; of at least one.
inline double percentile(std::vector<double> values, double share) {
  const auto nth =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

}  // namespace slammot::testing
