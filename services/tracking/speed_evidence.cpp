#include "services/tracking/speed_evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace slammot::tracking {
namespace {

constexpr std::array<double, 3> kAgesS = {0.1, 0.25, 0.6};
constexpr std::size_t kMostEchoes = 8;
constexpr int kSteps = 14;           ///< Of the speed, in each direction.
constexpr double kThere = 0.33;      ///< Log-likelihood ratio of an echo at the place: it may be of
                                     ///< another object.
constexpr double kThrough = -0.67;   ///< Of a beam through the place. Neighbouring beams are not
                                     ///< independent:
constexpr double kMostWeight = 1.5;  ///< a sampled echo counts at most this often for those left
                                     ///< out.

/// The object may have been behind another one: otherwise speeds at which it would have been in
/// view were preferred. It was not behind its own side.
bool is_hidden_by_another(const SightOfPlace& place, const EarlierScan& then, flow::TrackId own) {
  return place.sight == Sight::kHidden && then.owners[place.beam].is_owned &&
         then.owners[place.beam].track_id != own;
}

/// Log-likelihood of each speed of the search.
using SpeedLikelihoods = std::array<double, 2 * kSteps + 1>;

double speed_of(int i, double fastest_mps) { return (i - kSteps) * fastest_mps / kSteps; }

/// Speeds are normal with a sigma of half of the fastest.
SpeedLikelihoods prior(double fastest_mps) {
  SpeedLikelihoods log_likelihood;
  for (int i = 0; i <= 2 * kSteps; ++i)
    log_likelihood[static_cast<std::size_t>(i)] =
        -0.5 * std::pow(speed_of(i, fastest_mps) / (0.5 * fastest_mps), 2);
  return log_likelihood;
}

void add_scan(SpeedLikelihoods& log_likelihood, const DirectedEchoes& echoes,
              const EarlierScan& then, double fastest_mps) {
  const std::size_t stride = 1 + (echoes.points_m.size() - 1) / kMostEchoes;
  const double weight = std::min(kMostWeight, static_cast<double>(stride));
  const double time_s = static_cast<double>(echoes.stamp_ns - then.stamp_ns) * 1e-9;
  for (int i = 0; i <= 2 * kSteps; ++i) {
    const Eigen::Vector2d travelled_m = speed_of(i, fastest_mps) * time_s * echoes.direction;
    for (std::size_t echo = 0; echo < echoes.points_m.size(); echo += stride) {
      const SightOfPlace place = then.view.sight_of(echoes.points_m[echo] - travelled_m);
      const bool may_have_been_there =
          place.sight == Sight::kThere || is_hidden_by_another(place, then, echoes.own);
      log_likelihood[static_cast<std::size_t>(i)] +=
          weight * (place.sight == Sight::kThrough ? kThrough
                    : may_have_been_there          ? kThere
                                                   : 0.0);
    }
  }
}

/// Mean and sigma; the steps of the search add theirs.
SpeedEvidence moments_of(const SpeedLikelihoods& log_likelihood, double fastest_mps) {
  const double best = *std::max_element(log_likelihood.begin(), log_likelihood.end());
  double total = 0.0, mean = 0.0, square = 0.0;
  for (int i = 0; i <= 2 * kSteps; ++i) {
    const double likelihood = std::exp(log_likelihood[static_cast<std::size_t>(i)] - best);
    const double speed_mps = speed_of(i, fastest_mps);
    total += likelihood, mean += likelihood * speed_mps,
        square += likelihood * speed_mps * speed_mps;
  }
  mean /= total;
  const double step_mps = fastest_mps / kSteps;
  return {mean,
          std::sqrt(std::max(0.0, square / total - mean * mean) + step_mps * step_mps / 12.0)};
}

}  // namespace

SpeedEvidence speed_along(const DirectedEchoes& echoes, const ScanHistory& history,
                          double fastest_mps) {
  SpeedLikelihoods log_likelihood = prior(fastest_mps);
  const EarlierScan* before = nullptr;
  for (const double age_s : kAgesS) {
    const EarlierScan* then = history.older_than(echoes.stamp_ns, age_s);
    if (then == nullptr || then == before) continue;
    before = then;
    add_scan(log_likelihood, echoes, *then, fastest_mps);
  }
  return moments_of(log_likelihood, fastest_mps);
}

}  // namespace slammot::tracking
