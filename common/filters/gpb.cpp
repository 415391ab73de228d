#include "common/filters/gpb.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace slammot::filters {

Gpb1State gpb1_start(const ModelSet& set, const MotionState& estimate) {
  return {estimate, equal_weights(set)};
}

Gpb1State gpb1_step(const ModelSet& set, const Gpb1State& state, const PositionFix& fix) {
  assert(fix.after_s >= 0.0);
  Gpb1State next;
  std::array<MotionState, kMaxModels> modes;
  for (std::size_t to = 0; to < set.size; ++to) {
    double prior = 0.0;
    for (std::size_t from = 0; from < set.size; ++from)
      prior += switch_probability(set, from, to, fix.after_s) * state.probability[from];
    const auto update = update_with_position(predict(set.models[to], state.estimate, fix.after_s),
                                             fix.position_m, fix.R);
    modes[to] = update.posterior;
    next.probability[to] = update.innovation.log_likelihood + log_of(prior);
  }
  normalize_logs({next.probability.data(), set.size});
  next.estimate = moment_match({modes.data(), set.size}, {next.probability.data(), set.size});
  return next;
}

ImmState gpb2_step(const ModelSet& set, const ImmState& state, const PositionFix& fix) {
  assert(fix.after_s >= 0.0);
  ImmState next;
  for (std::size_t to = 0; to < set.size; ++to) {
    std::array<MotionState, kMaxModels> histories;
    ModelWeights weight = {};
    for (std::size_t from = 0; from < set.size; ++from) {
      const auto update = update_with_position(
          predict(set.models[to], state.modes[from], fix.after_s), fix.position_m, fix.R);
      histories[from] = update.posterior;
      weight[from] =
          update.innovation.log_likelihood +
          log_of(switch_probability(set, from, to, fix.after_s) * state.probability[from]);
    }
    next.probability[to] = normalize_logs({weight.data(), set.size});
    next.modes[to] = moment_match({histories.data(), set.size}, {weight.data(), set.size});
  }
  normalize_logs({next.probability.data(), set.size});
  return next;
}

}  // namespace slammot::filters
