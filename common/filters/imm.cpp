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
      probability[to] += weight[from] =
          (from == to ? switching.stays : switching.leaves) * state.probability[from];
    for (std::size_t from = 0; from < set.size; ++from) {
      if (probability[to] > 0.0) weight[from] /= probability[to];
      else weight[from] = from == to ? 1.0 : 0.0;  // a model of probability zero keeps its weight
    }
    const bool forgets_acceleration = set.models[to].kind == MotionKind::kConstantVelocity;
    const auto mixed = forgets_acceleration ? moment_match_moving : moment_match;
    return predict(set.models[to], mixed(modes_of(set, state), {weight.data(), set.size}), time_s);
  };
  static_assert(kMaxModels == 3);
  return {{predicted(0), predicted(1), predicted(2)}, probability};  // in place: zeroing a state
                                                                     // costs as much as a
                                                                     // prediction
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
  return predicted_over(time_s, switching_over(set, time_s), set, state);
}

Innovation<2> imm_innovation(const ModelSet& set, const ImmState& predicted,
                             const Eigen::Vector2d& position_m, const Eigen::Matrix2d& R) {
  const MotionState combined = imm_combine(set, predicted);
  return innovation<2>(position_m - combined.mean.head<2>(),
                       combined.covariance.topLeftCorner<2, 2>() + R);
}

ImmUpdate imm_update(const ModelSet& set, const ImmState& predicted,
                     const Eigen::Vector2d& position_m, const Eigen::Matrix2d& R) {
  ImmUpdate update;
  for (std::size_t i = 0; i < set.size; ++i) {
    const auto mode = update_with_position(predicted.modes[i], position_m, R);
    update.posterior.modes[i] = mode.posterior;
    update.posterior.probability[i] =
        mode.innovation.log_likelihood + std::log(std::max(predicted.probability[i], 1e-300));
  }
  update.log_likelihood = normalize_logs({update.posterior.probability.data(), set.size});
  return update;
}

ImmState imm_update_speed(const ModelSet& set, const ImmState& predicted,
                          const Eigen::Vector2d& direction, double speed_mps, double variance) {
  ImmState posterior = predicted;
  for (std::size_t i = 0; i < set.size; ++i) {
    MotionState& mode = posterior.modes[i];
    // H = (0, direction, 0)
    const Eigen::Matrix<double, 6, 1> Ph = mode.covariance.middleCols<2>(2) * direction;
    const double S = direction.dot(Ph.segment<2>(2)) + variance;
    mode.mean += Ph * ((speed_mps - direction.dot(mode.mean.segment<2>(2))) / S);
    mode.covariance -= Ph * (Ph.transpose() / S);
  }
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
  for (std::size_t i = 0; i < set.size; ++i) state.modes[i].mean.head<2>() += shift_m;
}

void imm_loosen(const ModelSet& set, ImmState& state, const Eigen::Matrix2d& covariance_m2) {
  for (std::size_t i = 0; i < set.size; ++i)
    state.modes[i].covariance.topLeftCorner<2, 2>() += covariance_m2;
}

}  // namespace slammot::filters
