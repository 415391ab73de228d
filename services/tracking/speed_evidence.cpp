#include "services/tracking/speed_evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace slammot::tracking {
namespace {

constexpr std::array<double, 3> kAgesS = {0.1, 0.25, 0.6};
constexpr std::size_t kMostEchoes = 8;
constexpr int kSteps = 14;               ///< Of the speed, in each direction.
constexpr double kThere = 0.33;     ///< Log-likelihood ratio of an echo at the place: it may be of another object.
constexpr double kThrough = -0.67;  ///< Of a beam through the place. Neighbouring beams are not independent:
constexpr double kMostWeight = 1.5; ///< a sampled echo counts at most this often for those left out.

/// The object may have been behind another one: otherwise speeds at which it would have been in view were preferred. It was not behind
/// its own side.
bool is_hidden_by_another(const SightOfPlace& place, const EarlierScan& then, flow::TrackId own) {
  return place.sight == Sight::kHidden && then.owners[place.beam].is_owned && then.owners[place.beam].track_id != own;
}

}  // namespace

SpeedEvidence speed_along(const Eigen::Vector2d& direction, std::span<const Eigen::Vector2d> echoes_m, std::int64_t stamp_ns,
                          const ScanHistory& history, double fastest_mps, flow::TrackId own) {
  std::array<double, 2 * kSteps + 1> log_likelihood;
  for (int i = 0; i <= 2 * kSteps; ++i) {
    const double speed_mps = (i - kSteps) * fastest_mps / kSteps;
    log_likelihood[static_cast<std::size_t>(i)] = -0.5 * std::pow(speed_mps / (0.5 * fastest_mps), 2);
  }
  const std::size_t stride = 1 + (echoes_m.size() - 1) / kMostEchoes;
  const double weight = std::min(kMostWeight, static_cast<double>(stride));
  const EarlierScan* before = nullptr;
  for (const double age_s : kAgesS) {
    const EarlierScan* then = history.older_than(stamp_ns, age_s);
    if (then == nullptr || then == before) continue;
    before = then;
    const double time_s = static_cast<double>(stamp_ns - then->stamp_ns) * 1e-9;
    for (int i = 0; i <= 2 * kSteps; ++i) {
      const Eigen::Vector2d travelled_m = (i - kSteps) * fastest_mps / kSteps * time_s * direction;
      for (std::size_t echo = 0; echo < echoes_m.size(); echo += stride) {
        const SightOfPlace place = then->view.sight_of(echoes_m[echo] - travelled_m);
        const bool may_have_been_there = place.sight == Sight::kThere || is_hidden_by_another(place, *then, own);
        log_likelihood[static_cast<std::size_t>(i)] += weight * (place.sight == Sight::kThrough ? kThrough : may_have_been_there ? kThere : 0.0);
      }
    }
  }
  const double best = *std::max_element(log_likelihood.begin(), log_likelihood.end());
  double total = 0.0, mean = 0.0, square = 0.0;
  for (int i = 0; i <= 2 * kSteps; ++i) {
    const double likelihood = std::exp(log_likelihood[static_cast<std::size_t>(i)] - best);
    const double speed_mps = (i - kSteps) * fastest_mps / kSteps;
    total += likelihood, mean += likelihood * speed_mps, square += likelihood * speed_mps * speed_mps;
  }
  mean /= total;
  const double step_mps = fastest_mps / kSteps;
  return {mean, std::sqrt(std::max(0.0, square / total - mean * mean) + step_mps * step_mps / 12.0)};
}

}  // namespace slammot::tracking
