#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace slammot::geometry {

/// Of an odd count the median, of an even one the greater of the two in the middle; 0 for none.
/// Reorders the values.
template <typename Value>
Value upper_median_in_place(std::vector<Value>& values) {
  if (values.empty()) return Value{};
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The same of values that keep their order.
template <typename Value>
Value upper_median(std::vector<Value> values) {
  return upper_median_in_place(values);
}

/// Quantile at this share, [0, 1]: the value of rank floor(share (n - 1)) of n, counted from 0,
/// without interpolation; 0 for none. At 0.5 of an even count the lesser of the two in the middle.
inline double lower_quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

}  // namespace slammot::geometry
