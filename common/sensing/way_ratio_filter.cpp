#include "common/sensing/way_ratio_filter.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

namespace slammot::sensing {
namespace {

constexpr double kRightShare = 0.04;  // tolerance of correct odometry around ratio 1
constexpr double kRightPrior = 0.9;
constexpr double kChanges = 0.03;  // probability per comparison that the ratio is redrawn from the
                                   // prior,
constexpr double kDrifts = 0.1;    // and that it moves to a neighbouring ratio

bool is_right(double ratio) { return std::abs(ratio - 1.0) < kRightShare; }

WayRatioFilter::Profile prior() {
  const auto right = static_cast<double>(std::ranges::count_if(WayRatioFilter::kRatios, is_right));
  const double wrong = static_cast<double>(WayRatioFilter::kRatios.size()) - right;
  WayRatioFilter::Profile weights;
  for (std::size_t i = 0; i < weights.size(); ++i)
    weights[i] =
        is_right(WayRatioFilter::kRatios[i]) ? kRightPrior / right : (1.0 - kRightPrior) / wrong;
  return weights;
}

}  // namespace

WayRatioFilter::WayRatioFilter() : weights_(prior()) {}

void WayRatioFilter::update(const Profile& log_likelihoods) {
  const double highest = *std::ranges::max_element(log_likelihoods);
  const Profile fresh = prior();
  const Profile before = weights_;
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    const double below = before[i > 0 ? i - 1 : i];
    const double above = before[i + 1 < before.size() ? i + 1 : i];
    const double drifted = (1.0 - kDrifts) * before[i] + 0.5 * kDrifts * (below + above);
    weights_[i] =
        ((1.0 - kChanges) * drifted + kChanges * fresh[i]) * std::exp(log_likelihoods[i] - highest);
  }
  const double sum = std::accumulate(weights_.begin(), weights_.end(), 0.0);
  for (double& weight : weights_) weight /= sum;
}

void WayRatioFilter::doubt() {
  constexpr double kRedrawn = 0.5;
  const Profile fresh = prior();
  for (std::size_t i = 0; i < weights_.size(); ++i)
    weights_[i] = (1.0 - kRedrawn) * weights_[i] +
                  kRedrawn * (is_right(kRatios[i]) ? 0.0 : fresh[i] / (1.0 - kRightPrior));
}

WayRatioFilter::Profile WayRatioFilter::prominent(Profile profile, double least) {
  const auto n = static_cast<double>(profile.size());
  const double mean_ratio = std::accumulate(kRatios.begin(), kRatios.end(), 0.0) / n;
  const double mean = std::accumulate(profile.begin(), profile.end(), 0.0) / n;
  double covariance = 0.0;
  double variance = 0.0;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    covariance += (kRatios[i] - mean_ratio) * (profile[i] - mean);
    variance += (kRatios[i] - mean_ratio) * (kRatios[i] - mean_ratio);
  }
  const bool rises_to_its_end = profile.back() - mean >= least;
  for (std::size_t i = 0; i < profile.size(); ++i)
    profile[i] -= mean + covariance / variance * (kRatios[i] - mean_ratio);
  const auto highest = std::ranges::max_element(profile);
  const bool is_at_an_end =
      highest == profile.begin() || (std::next(highest) == profile.end() && !rises_to_its_end);
  if (*highest < least || is_at_an_end) profile.fill(0.0);
  return profile;
}

double WayRatioFilter::sound_probability() const {
  double sum = 0.0;
  for (std::size_t i = 0; i < weights_.size(); ++i) sum += is_right(kRatios[i]) ? weights_[i] : 0.0;
  return sum;
}

bool WayRatioFilter::is_sound() const {
  const auto is_probability = [](double weight) { return weight >= 0.0 && weight <= 1.0; };
  return std::ranges::all_of(weights_, is_probability) && *std::ranges::max_element(weights_) > 0.0;
}

double WayRatioFilter::most_likely_ratio() const {
  return kRatios[static_cast<std::size_t>(std::ranges::max_element(weights_) - weights_.begin())];
}

}  // namespace slammot::sensing
