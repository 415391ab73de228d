#pragma once

#include "common/config/fields.hpp"
#include "examples/greedy_tracker/greedy_tracker.hpp"

namespace slammot::greedy_tracker {

/// The settings of stage `tracking` that this implementation reads. A profile sets them for all
/// implementations.
inline const config::FieldTable<GreedyTrackerConfig>& greedy_tracker_fields() {
  using C = GreedyTrackerConfig;
  static const config::FieldTable<C> table = {
      {"fastest_mps", &C::fastest_mps, "One sigma of a new track's speed is half of this.",
       config::kPositive},
  };
  return table;
}

}  // namespace slammot::greedy_tracker
