#include "services/tracking/existence.hpp"

#include <cmath>

namespace slammot::tracking {

Consistency with_scan(const Consistency& before, double off_sides_m, double nis, double time_s) {
  constexpr double kMemoryS = 0.4;
  constexpr double kMostNis = 50.0;  // limits single outliers
  const double kept = std::exp(-time_s / kMemoryS) * before.weight;
  return {(kept * before.off_sides_m + off_sides_m) / (kept + 1.0),
          (kept * before.nis + std::min(nis, kMostNis)) / (kept + 1.0), kept + 1.0};
}

BeamPassage with_beams(const BeamPassage& before, int through, std::size_t met, double time_s) {
  constexpr double kMemoryS = 0.4;
  const double gain = 1.0 - std::exp(-time_s / kMemoryS);
  return {before.through + gain * (through - before.through),
          before.met + gain * (static_cast<double>(met) - before.met)};
}

double existence_of(double score) { return 1.0 / (1.0 + std::exp(-score)); }

}  // namespace slammot::tracking
