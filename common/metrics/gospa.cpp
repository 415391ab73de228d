#include "common/metrics/gospa.hpp"

#include <cmath>

#include "common/metrics/matching.hpp"

namespace slammot::metrics {

Gospa gospa(const Eigen::MatrixXd& distance_m, double cutoff_m) {
  const double cutoff_m2 = cutoff_m * cutoff_m;
  // A pair saves the costs of a missed object and a false track, together the squared cutoff.
  const auto pairs = best_pairs((cutoff_m2 - distance_m.array().square()).matrix());
  Gospa result;
  for (const auto& [object, track] : pairs) {
    const double d_m =
        distance_m(static_cast<Eigen::Index>(object), static_cast<Eigen::Index>(track));
    result.localization_m2 += d_m * d_m;
  }
  const auto pair_count = static_cast<double>(pairs.size());
  result.missed_m2 = 0.5 * cutoff_m2 * (static_cast<double>(distance_m.rows()) - pair_count);
  result.false_tracks_m2 = 0.5 * cutoff_m2 * (static_cast<double>(distance_m.cols()) - pair_count);
  result.distance_m = std::sqrt(result.localization_m2 + result.missed_m2 + result.false_tracks_m2);
  return result;
}

}  // namespace slammot::metrics
