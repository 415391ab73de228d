#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "common/geometry/order_statistics.hpp"

namespace slammot::sensing {

/// From each stamp to the next.
inline std::vector<std::int64_t> steps_of(std::span<const std::int64_t> stamps) {
  std::vector<std::int64_t> steps;
  for (std::size_t i = 1; i < stamps.size(); ++i) steps.push_back(stamps[i] - stamps[i - 1]);
  return steps;
}

/// Of the values for which the predicate holds; 0 of none.
template <typename Values, typename Predicate>
double share_of(const Values& values, Predicate is_counted) {
  if (values.empty()) return 0.0;
  return static_cast<double>(std::count_if(values.begin(), values.end(), is_counted)) /
         static_cast<double>(values.size());
}

/// Of the steps that advance; 0 if none does.
inline std::int64_t median_advance_ns(std::span<const std::int64_t> stamps) {
  std::vector<std::int64_t> advances = steps_of(stamps);
  std::erase_if(advances, [](std::int64_t step_ns) { return step_ns <= 0; });
  return geometry::upper_median(std::move(advances));
}

}  // namespace slammot::sensing
