#include "common/filters/imm.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "common/filters/kalman.hpp"

namespace slammot::filters {
namespace {

using Weights = std::array<double, kMaxModels>;

/// Mean and covariance of the Gaussians of `state`, weighted.
MotionState moment_match(const ModelSet& set, const ImmState& state, const Weights& weight) {
  MotionState mixture;
  for (std::size_t i = 0; i < set.size; ++i) mixture.mean += weight[i] * state.modes[i].mean;
  for (std::size_t i = 0; i < set.size; ++i) {
    const Vector6 spread = state.modes[i].mean - mixture.mean;
    mixture.covariance += weight[i] * (state.modes[i].covariance + spread * spread.transpose());
  }
  return mixture;
}

/// Probability to be in model `to` after the time when now in `from`.
double switch_probability(const ModelSet& set, std::size_t from, std::size_t to, double time_s) {
  if (set.size == 1) return 1.0;
  const double stay = std::exp(-time_s / set.mean_stay_s);
  return from == to ? stay : (1.0 - stay) / static_cast<double>(set.size - 1);
}

}  // namespace

ImmState imm_start(const ModelSet& set, const MotionState& estimate) {
  assert(set.size >= 1 && set.size <= kMaxModels);
  ImmState state;
  for (std::size_t i = 0; i < set.size; ++i) {
    state.modes[i] = estimate;
    state.probability[i] = 1.0 / static_cast<double>(set.size);
  }
  return state;
}

ImmState imm_predict(const ModelSet& set, const ImmState& state, double time_s) {
  assert(time_s >= 0.0);
  ImmState predicted;
  for (std::size_t to = 0; to < set.size; ++to) {
    Weights weight = {};
    double total = 0.0;
    for (std::size_t from = 0; from < set.size; ++from) {
      weight[from] = switch_probability(set, from, to, time_s) * state.probability[from];
      total += weight[from];
    }
    predicted.probability[to] = total;
    if (total > 0.0) {
      for (std::size_t from = 0; from < set.size; ++from) weight[from] /= total;
    } else {
      weight[to] = 1.0;  // no time has passed for a model that was ruled out
    }
    predicted.modes[to] = predict(set.models[to], moment_match(set, state, weight), time_s);
  }
  return predicted;
}

ImmUpdate imm_update(const ModelSet& set, const ImmState& predicted, const Eigen::Vector2d& position_m,
                     const Eigen::Matrix2d& R) {
  // The measurement is the position itself, so H picks the first two states and the general update shortens to blocks.
  ImmUpdate update;
  const MotionState combined = imm_combine(set, predicted);
  update.innovation = innovation<2>(position_m - combined.mean.head<2>(), combined.covariance.topLeftCorner<2, 2>() + R);
  Eigen::Matrix<double, 2, 6> H = Eigen::Matrix<double, 2, 6>::Zero();
  H(0, 0) = H(1, 1) = 1.0;
  Weights log_weight = {};
  double largest = -1e300;
  for (std::size_t i = 0; i < set.size; ++i) {
    const auto mode = kalman_update<6, 2>(predicted.modes[i], position_m, H, R);
    update.posterior.modes[i] = mode.posterior;
    log_weight[i] = mode.innovation.log_likelihood + std::log(std::max(predicted.probability[i], 1e-300));
    largest = std::max(largest, log_weight[i]);
  }
  double total = 0.0;
  for (std::size_t i = 0; i < set.size; ++i) total += update.posterior.probability[i] = std::exp(log_weight[i] - largest);
  for (std::size_t i = 0; i < set.size; ++i) update.posterior.probability[i] /= total;
  update.log_likelihood = largest + std::log(total);
  return update;
}

MotionState imm_combine(const ModelSet& set, const ImmState& state) {
  return moment_match(set, state, state.probability);
}

void imm_shift(const ModelSet& set, ImmState& state, const Eigen::Vector2d& shift_m) {
  for (std::size_t i = 0; i < set.size; ++i) state.modes[i].mean.head<2>() += shift_m;
}

}  // namespace slammot::filters
