#include "common/filters/imm.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace slammot::filters {
namespace {

std::span<const MotionState> modes_of(const ModelSet& set, const ImmState& state) {
  return {state.modes.data(), set.size};
}

/// Applies a change to the estimates of all models, and of all pairs of models where GPB2 keeps
/// them.
template <typename Change>
void for_each_estimate(const ModelSet& set, ImmState& state, const Change& change) {
  for (std::size_t i = 0; i < set.size; ++i) change(state.modes[i]);
  for (MotionState& pair : state.pairs) change(pair);
}

bool has_models_beyond(const ModelSet& set, const ImmState& state) {
  double beyond = 0.0;
  for (std::size_t i = set.size; i < kMaxModels; ++i) beyond += state.probability[i];
  return beyond > 0.0;
}

/// Merges the models that are no longer in the set into the last remaining one.
ImmState narrowed(const ModelSet& set, const ImmState& state) {
  ImmState narrow = state;
  const std::size_t last = set.size - 1;
  const std::span all{state.probability};
  const double total =
      std::accumulate(all.begin() + static_cast<std::ptrdiff_t>(last), all.end(), 0.0);
  ModelWeights weight = {};
  for (std::size_t i = last; i < kMaxModels; ++i) {
    weight[i] = state.probability[i] / total;
    narrow.probability[i] = 0.0;
  }
  narrow.modes[last] = moment_match({state.modes.data() + last, kMaxModels - last},
                                    {weight.data() + last, kMaxModels - last});
  narrow.probability[last] = total;
  return narrow;
}

/// Probabilities over a time step to stay in a model and to switch to each other model.
struct Switching {
  double stays = 1.0;
  double leaves = 0.0;

  double probability(std::size_t from, std::size_t to) const { return from == to ? stays : leaves; }
};

Switching switching_over(const ModelSet& set, double time_s) {  // the same for every model
  if (set.size == 1) return {};
  return {switch_probability(set, 0, 0, time_s), switch_probability(set, 0, 1, time_s)};
}

ImmState predicted_over(double time_s, const Switching& switching, const ModelSet& set,
                        const ImmState& state) {
  if (has_models_beyond(set, state))
    return predicted_over(time_s, switching, set, narrowed(set, state));
  ModelWeights probability = {};
  const auto predicted = [&](std::size_t to) {
    if (to >= set.size) return MotionState{};
    ModelWeights weight = {};
    for (std::size_t from = 0; from < set.size; ++from)
      probability[to] += weight[from] = switching.probability(from, to) * state.probability[from];
    if (set.mixture == Mixture::kGpb1) weight = state.probability;
    for (std::size_t from = 0; from < set.size && set.mixture != Mixture::kGpb1; ++from) {
      if (probability[to] > 0.0) weight[from] /= probability[to];
      else weight[from] = from == to ? 1.0 : 0.0;  // a model of probability zero keeps its weight
    }
    const bool forgets_acceleration = set.models[to].kind == MotionKind::kConstantVelocity;
    const auto mixed = forgets_acceleration ? moment_match_moving : moment_match;
    return predict(set.models[to], mixed(modes_of(set, state), {weight.data(), set.size}), time_s);
  };
  static_assert(kMaxModels == 3);
  // in place: zeroing a state costs as much as a prediction
  return {{predicted(0), predicted(1), predicted(2)}, probability, {}, {}};
}

/// Adds the predictions of all pairs of models to a prediction whose modes they are merged into.
void predict_pairs(double time_s, const Switching& switching, const ModelSet& set,
                   const ImmState& state, ImmState& predicted) {
  for (std::size_t to = 0; to < set.size; ++to) {
    for (std::size_t from = 0; from < set.size; ++from) {
      predicted.pairs.push_back(predict(set.models[to], state.modes[from], time_s));
      predicted.pair_probability.push_back(switching.probability(from, to) *
                                           state.probability[from]);
    }
  }
}

/// Updates the pairs and merges those that end in the same model.
ImmUpdate updated_by_pairs(const ModelSet& set, const ImmState& predicted,
                           const Eigen::Vector2d& position_m, const Eigen::Matrix2d& R) {
  assert(predicted.pairs.size() == set.size * set.size);
  ImmUpdate update;
  for (std::size_t to = 0; to < set.size; ++to) {
    std::array<MotionState, kMaxModels> histories;
    ModelWeights weight = {};
    for (std::size_t from = 0; from < set.size; ++from) {
      const std::size_t pair = to * set.size + from;
      const auto mode = update_with_position(predicted.pairs[pair], position_m, R);
      histories[from] = mode.posterior;
      weight[from] = mode.innovation.log_likelihood + log_of(predicted.pair_probability[pair]);
    }
    update.posterior.probability[to] = normalize_logs({weight.data(), set.size});
    update.posterior.modes[to] =
        moment_match({histories.data(), set.size}, {weight.data(), set.size});
  }
  update.log_likelihood = normalize_logs({update.posterior.probability.data(), set.size});
  return update;
}

/// Update of one mode by a velocity component, H = (0, direction, 0).
void update_speed(MotionState& mode, const Eigen::Vector2d& direction, double speed_mps,
                  double variance) {
  const Eigen::Matrix<double, 6, 1> Ph = mode.covariance.middleCols<2>(2) * direction;
  const double S = direction.dot(Ph.segment<2>(2)) + variance;
  mode.mean += Ph * ((speed_mps - direction.dot(mode.mean.segment<2>(2))) / S);
  mode.covariance -= Ph * (Ph.transpose() / S);
}

/// Predicts in place: a state has a kilobyte and is not copied (imm_path in
/// multiple_models_bench.cpp).
void foretell(const ModelSet& set, const ImmState& state, double step_s, const Switching& switching,
              std::span<Gaussian<2>> path) {
  if (path.empty()) return;
  const ImmState next = predicted_over(step_s, switching, set, state);
  path.front() = moment_match_position(modes_of(set, next), {next.probability.data(), set.size});
  foretell(set, next, step_s, switching, path.subspan(1));
}

}  // namespace

ImmState imm_start(const ModelSet& set, const MotionState& estimate) {
  ImmState state;
  state.probability = equal_weights(set);
  for (std::size_t i = 0; i < set.size; ++i) state.modes[i] = estimate;
  return state;
}

ImmState imm_predict(const ModelSet& set, const ImmState& state, double time_s) {
  assert(time_s >= 0.0);
  const Switching switching = switching_over(set, time_s);
  if (set.mixture != Mixture::kGpb2) return predicted_over(time_s, switching, set, state);
  const ImmState before = has_models_beyond(set, state) ? narrowed(set, state) : state;
  ImmState predicted = predicted_over(time_s, switching, set, before);
  predict_pairs(time_s, switching, set, before, predicted);
  return predicted;
}

Innovation<2> imm_innovation(const ModelSet& set, const ImmState& predicted,
                             const Eigen::Vector2d& position_m, const Eigen::Matrix2d& R) {
  const MotionState combined = imm_combine(set, predicted);
  return innovation<2>(position_m - combined.mean.head<2>(),
                       combined.covariance.topLeftCorner<2, 2>() + R);
}

ImmUpdate imm_update(const ModelSet& set, const ImmState& predicted,
                     const Eigen::Vector2d& position_m, const Eigen::Matrix2d& R) {
  if (!predicted.pairs.empty()) return updated_by_pairs(set, predicted, position_m, R);
  ImmUpdate update;
  for (std::size_t i = 0; i < set.size; ++i) {
    const auto mode = update_with_position(predicted.modes[i], position_m, R);
    update.posterior.modes[i] = mode.posterior;
    update.posterior.probability[i] =
        mode.innovation.log_likelihood + log_of(predicted.probability[i]);
  }
  update.log_likelihood = normalize_logs({update.posterior.probability.data(), set.size});
  return update;
}

ImmState imm_update_speed(const ModelSet& set, const ImmState& predicted,
                          const Eigen::Vector2d& direction, double speed_mps, double variance) {
  ImmState posterior = predicted;
  for_each_estimate(set, posterior, [&](MotionState& estimate) {
    update_speed(estimate, direction, speed_mps, variance);
  });
  return posterior;
}

MotionState imm_combine(const ModelSet& set, const ImmState& state) {
  return moment_match(modes_of(set, state), {state.probability.data(), set.size});
}

void imm_foretell(const ModelSet& set, const ImmState& state, double step_s,
                  std::span<Gaussian<2>> path) {
  foretell(set, state, step_s, switching_over(set, step_s), path);
}

void imm_shift(const ModelSet& set, ImmState& state, const Eigen::Vector2d& shift_m) {
  for_each_estimate(set, state, [&](MotionState& estimate) { estimate.mean.head<2>() += shift_m; });
}

void imm_loosen(const ModelSet& set, ImmState& state, const Eigen::Matrix2d& covariance_m2) {
  for_each_estimate(set, state, [&](MotionState& estimate) {
    estimate.covariance.topLeftCorner<2, 2>() += covariance_m2;
  });
}

void imm_add_acceleration_noise(const ModelSet& set, ImmState& state,
                                const Eigen::Matrix2d& density, double time_s) {
  for_each_estimate(set, state, [&](MotionState& estimate) {
    estimate.covariance.topLeftCorner<2, 2>() += density * std::pow(time_s, 3) / 3.0;
    estimate.covariance.block<2, 2>(0, 2) += density * time_s * time_s / 2.0;
    estimate.covariance.block<2, 2>(2, 0) += density * time_s * time_s / 2.0;
    estimate.covariance.block<2, 2>(2, 2) += density * time_s;
  });
}

}  // namespace slammot::filters
