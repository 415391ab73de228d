#pragma once

#include <array>
#include <cstddef>

#include "common/metrics/matching.hpp"

namespace slammot::metrics {

/// Similarity thresholds: 0.05, 0.10, ... 0.95.
inline constexpr std::size_t kHotaThresholds = 19;

/// Higher order tracking accuracy: Luiten et al. 2021.
struct Hota {
  std::array<double, kHotaThresholds> hota_at{};
  double hota = 0.0;  ///< Means over the thresholds, like the following:
  double detection_accuracy = 0.0;
  double association_accuracy = 0.0;
  double detection_recall = 0.0;
  double detection_precision = 0.0;
  double localization_accuracy = 0.0;  ///< Mean similarity of the pairs.
};

Hota hota(const MotSequence& sequence);

}  // namespace slammot::metrics
