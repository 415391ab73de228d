#include "common/filters/model_set.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace slammot::filters {

ModelWeights equal_weights(const ModelSet& set) {
  assert(set.size >= 1 && set.size <= kMaxModels);
  ModelWeights weight = {};
  for (std::size_t i = 0; i < set.size; ++i) weight[i] = 1.0 / static_cast<double>(set.size);
  return weight;
}

double switch_probability(const ModelSet& set, std::size_t from, std::size_t to, double time_s) {
  if (set.size == 1) return 1.0;
  const double stay = std::exp(-time_s / set.mean_stay_s);
  return from == to ? stay : (1.0 - stay) / static_cast<double>(set.size - 1);
}

MotionState moment_match(std::span<const MotionState> modes, std::span<const double> weight) {
  assert(modes.size() == weight.size());
  MotionState mixture{weight[0] * modes[0].mean, weight[0] * modes[0].covariance};
  for (std::size_t i = 1; i < modes.size(); ++i) {
    mixture.mean += weight[i] * modes[i].mean;
    mixture.covariance += weight[i] * modes[i].covariance;
    // The spread about the common mean as that between each two: half as many products.
    for (std::size_t j = 0; j < i; ++j) {
      const Vector6 apart = modes[i].mean - modes[j].mean;
      mixture.covariance.noalias() += (weight[i] * weight[j] * apart) * apart.transpose();
    }
  }
  return mixture;
}

double normalize_logs(std::span<double> log_weight) {
  const double largest = *std::max_element(log_weight.begin(), log_weight.end());
  double total = 0.0;
  for (double& weight : log_weight) total += weight = std::exp(weight - largest);
  for (double& weight : log_weight) weight /= total;
  return largest + std::log(total);
}

KalmanUpdate<6, 2> update_with_position(const MotionState& predicted, const Eigen::Vector2d& position_m, const Eigen::Matrix2d& R) {
  Eigen::Matrix<double, 2, 6> H = Eigen::Matrix<double, 2, 6>::Zero();
  H(0, 0) = H(1, 1) = 1.0;
  return kalman_update<6, 2>(predicted, position_m, H, R);
}

}  // namespace slammot::filters
