#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <vector>

namespace slammot::evaluator {

/// Tolerance of stamps of one log, which may be rounded; less than the interval of scans.
inline constexpr std::int64_t kSameStampNs = 1'000'000;

/// The element with the nearest stamp, if the difference is within the tolerance; otherwise null.
/// Elements ascend.
template <typename Element>
const Element* at_stamp(const std::vector<Element>& elements, std::int64_t stamp_ns,
                        std::int64_t max_difference_ns) {
  auto after = std::lower_bound(
      elements.begin(), elements.end(), stamp_ns,
      [](const Element& element, std::int64_t stamp) { return element.stamp_ns < stamp; });
  if (after != elements.begin() &&
      (after == elements.end() ||
       stamp_ns - std::prev(after)->stamp_ns < after->stamp_ns - stamp_ns))
    --after;
  return after != elements.end() && std::abs(after->stamp_ns - stamp_ns) <= max_difference_ns
             ? &*after
             : nullptr;
}

}  // namespace slammot::evaluator
