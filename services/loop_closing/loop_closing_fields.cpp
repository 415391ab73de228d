#include "services/loop_closing/loop_closing_fields.hpp"

#include "services/loop_closing/surroundings.hpp"

namespace slammot::loop_closing {
namespace {

using config::FieldTable;
using config::kNotNegative;
using config::kPositive;

config::Field<LoopClosingConfig> surroundings_field() {
  return {"surroundings",
          [](LoopClosingConfig& config) -> config::Value {
            return config::Choice{[&config] { return static_cast<int>(config.surroundings); },
                                  [&config](int number) {
                                    set_surroundings(config, static_cast<Surroundings>(number));
                                  }};
          },
          "What submaps show: streets or the rooms of a building. Sets the width of searches for "
          "revisits and how exactly walls of two submaps agree.",
          {}};
}

config::Field<LoopClosingConfig> estimator_field() {
  return {"estimator",
          [](LoopClosingConfig& config) -> config::Value {
            return config::value_in(config.graph.estimator);
          },
          "What estimates the poses of the submaps: graph, least squares over all constraints, or "
          "ekf, a Kalman filter over submaps as features (docs/decisions/loop-closing.md).",
          {}};
}

FieldTable<LoopClosingConfig> all_fields() {
  using C = LoopClosingConfig;
  FieldTable<C> table = {
      {"min_travel_between_m",
       &C::min_travel_between_m,
       "Least distance driven between two submaps of a revisit.",
       kNotNegative,
       {"A submap is matched to the one just left, which adds no information.",
        "Small loops are not closed."}},
      {"max_distance_m",
       &C::max_distance_m,
       "Greatest distance between the centres of two submaps that may show the same place.",
       kPositive,
       {"Revisits on another lane or corridor are missed.",
        "Searches are spent on submaps that share nothing."}},
      {"sure_within_m",
       &C::sure_within_m,
       "One match suffices if the one-sigma error of the expected position is smaller.",
       kNotNegative,
       {"Loops close late, after several submaps agree.",
        "A single look-alike closes a wrong loop."}},
  };
  table.push_back(surroundings_field());
  table.push_back(estimator_field());
  return config::in_group(config::Group::closing, std::move(table));
}

}  // namespace

const FieldTable<LoopClosingConfig>& loop_closing_fields() {
  static const FieldTable<LoopClosingConfig> table = all_fields();
  return table;
}

}  // namespace slammot::loop_closing
