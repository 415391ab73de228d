#include "common/matching/common_factor.hpp"

#include <algorithm>

namespace slammot::matching {

double error_with_best_factor(std::span<const TwiceMeasured> quantities, double factor_sigma) {
  constexpr int kReweighings = 3;
  constexpr double kWorstSquared = 9.0;  // of one; limits the effect of wrong matches
  double factor = 1.0;
  double error = 0.0;
  for (int round = 0; round < kReweighings; ++round) {
    double weighted = 1.0 / (factor_sigma * factor_sigma);
    double information = weighted;
    error = 0.0;
    for (const auto& [by_scans, sigma, by_odometry] : quantities) {
      const double difference = (by_scans - factor * by_odometry) / sigma;
      const double squared = difference * difference;
      error += std::min(squared, kWorstSquared);
      if (squared > kWorstSquared) continue;
      const double weight = 1.0 / (sigma * sigma);
      weighted += weight * by_odometry * by_scans;
      information += weight * by_odometry * by_odometry;
    }
    factor = weighted / information;
  }
  return error;
}

double information_about_delay(std::span<const DelayedQuantity> quantities, double factor_sigma) {
  double by_delay = 0.0;
  double by_both = 0.0;
  double by_factor = 1.0 / (factor_sigma * factor_sigma);
  for (const auto& [by_odometry, change_per_s, sigma] : quantities) {
    const double weight = 1.0 / (sigma * sigma);
    by_delay += weight * change_per_s * change_per_s;
    by_both += weight * change_per_s * by_odometry;
    by_factor += weight * by_odometry * by_odometry;
  }
  return by_delay - by_both * by_both / by_factor;
}

}  // namespace slammot::matching
