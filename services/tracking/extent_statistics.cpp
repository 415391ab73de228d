#include "services/tracking/extent_statistics.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::tracking {

double ResponseRate::unanswered_share() const {
  constexpr double kPrior = 0.2;  // of one beam
  return (missed + kPrior) / (asked + 1.0);
}

ResponseRate with_responses(ResponseRate responses, std::size_t echoes, int gaps, double time_s) {
  constexpr double kMemoryS = 1.0;
  const double kept = std::exp(-time_s / kMemoryS);
  const double between = echoes > 2 ? static_cast<double>(echoes - 2) : 0.0;  // the two outermost
                                                                              // are echoes by
                                                                              // definition
  return {kept * responses.missed + gaps, kept * responses.asked + gaps + between};
}

HeadingNoise with_heading(const HeadingNoise& before, double off_rad, double variance_rad2,
                          double time_s) {
  constexpr double kMemoryS = 1.5;
  constexpr double kMostShare = 4.0;
  const double seen = std::min(off_rad * off_rad / variance_rad2, kMostShare);
  return {before.share + (1.0 - std::exp(-time_s / kMemoryS)) * (seen - before.share)};
}

OutlineError with_outline(const OutlineError& before, double off_sides_m, std::size_t echoes,
                          double range_m, const TrackingConfig& config) {
  constexpr std::size_t kFewest = 6;  // the box passes through each of fewer echoes
  constexpr double kMostShare = 2.0;  // echoes farther off are not on a side
  const double share =
      std::max(0.0, off_sides_m - kRangeNoisePerM * range_m) / config.sensor.range_noise_m;
  if (echoes < kFewest || share > kMostShare) return before;
  const double weight = static_cast<double>(echoes);
  return {before.shares + weight * share, before.echoes + weight, before.scans + 1};
}

}  // namespace slammot::tracking
