#include "services/loop_closing/loop_closing_fields.hpp"

namespace slammot::loop_closing {
namespace {

using config::FieldTable;
using config::kNotNegative;
using config::kPositive;
using config::Range;
using config::with_nested;

FieldTable<PlaceConfig> place_fields() {
  return {{"tolerance_m",
           &PlaceConfig::tolerance_m,
           "Walls of two submaps within this distance agree.",
           Range{0.0, 5.0},
           {"True revisits seem to contradict the map and are rejected.",
            "Different places seem to agree."}}};
}

FieldTable<RegistrationConfig> registration_fields() {
  using C = RegistrationConfig;
  return {
      {"fine_gate_m",
       &C::fine_gate_m,
       "Greatest distance of paired surfels in the last steps of a registration; 2.5 times as "
       "much in the first ones.",
       Range{0.01, 10.0},
       {"Few pairs are left, and the closure is weak.",
        "Surfels of other walls bias the closure."}},
      {"surfel_sigma_m",
       &C::surfel_sigma_m,
       "One sigma of the distance between two surfels of one wall, across the wall.",
       kPositive,
       {"Closures are overconfident and distort the graph.",
        "Closures weigh too little to correct the drift."}},
  };
}

FieldTable<RevisitConfig> revisit_fields() {
  using C = RevisitConfig;
  return with_nested<C>(
      {
          {"max_window_m",
           &C::max_window_m,
           "Greatest half width of the search window around the expected pose.",
           Range{0.1, 200.0},
           {"A drive that has drifted farther finds no revisit.",
            "Searches take long, and look-alikes are found."}},
          {"astray_window_m",
           &C::astray_window_m,
           "Half width of the search window with unknown heading.",
           kPositive,
           {"A lost vehicle is not located.", "Searches take long."}},
      },
      "registration", &C::registration, registration_fields());
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
  table = with_nested(std::move(table), "place", &C::place, place_fields());
  table = with_nested(std::move(table), "revisit", &C::revisit, revisit_fields());
  table.push_back(estimator_field());
  return config::in_group(config::Group::closing, std::move(table));
}

}  // namespace

const FieldTable<LoopClosingConfig>& loop_closing_fields() {
  static const FieldTable<LoopClosingConfig> table = all_fields();
  return table;
}

}  // namespace slammot::loop_closing
