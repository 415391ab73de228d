#include "common/filters/imm.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace slammot::filters {
namespace {

std::span<const MotionState> modes_of(const ModelSet& set, const ImmState& state) { return {state.modes.data(), set.size}; }

}  // namespace

ImmState imm_start(const ModelSet& set, const MotionState& estimate) {
  ImmState state;
  state.probability = equal_weights(set);
  for (std::size_t i = 0; i < set.size; ++i) state.modes[i] = estimate;
  return state;
}

ImmState imm_predict(const ModelSet& set, const ImmState& state, double time_s) {
  assert(time_s >= 0.0);
  ImmState predicted;
  for (std::size_t to = 0; to < set.size; ++to) {
    ModelWeights weight = {};
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
    predicted.modes[to] = predict(set.models[to], moment_match(modes_of(set, state), {weight.data(), set.size}), time_s);
  }
  return predicted;
}

ImmUpdate imm_update(const ModelSet& set, const ImmState& predicted, const Eigen::Vector2d& position_m,
                     const Eigen::Matrix2d& R) {
  ImmUpdate update;
  const MotionState combined = imm_combine(set, predicted);
  update.innovation = innovation<2>(position_m - combined.mean.head<2>(), combined.covariance.topLeftCorner<2, 2>() + R);
  for (std::size_t i = 0; i < set.size; ++i) {
    const auto mode = update_with_position(predicted.modes[i], position_m, R);
    update.posterior.modes[i] = mode.posterior;
    update.posterior.probability[i] = mode.innovation.log_likelihood + std::log(std::max(predicted.probability[i], 1e-300));
  }
  update.log_likelihood = normalize_logs({update.posterior.probability.data(), set.size});
  return update;
}

MotionState imm_combine(const ModelSet& set, const ImmState& state) {
  return moment_match(modes_of(set, state), {state.probability.data(), set.size});
}

void imm_shift(const ModelSet& set, ImmState& state, const Eigen::Vector2d& shift_m) {
  for (std::size_t i = 0; i < set.size; ++i) state.modes[i].mean.head<2>() += shift_m;
}

}  // namespace slammot::filters
