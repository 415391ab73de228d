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
           "A wall of one submap this near to a wall of the other agrees with it.",
           Range{0.0, 5.0},
           {"True revisits seem to contradict the map and are refused.",
            "Different places seem to agree."}}};
}

FieldTable<RegistrationConfig> registration_fields() {
  using C = RegistrationConfig;
  return {
      {"coarse_gate_m",
       &C::coarse_gate_m,
       "Surfels farther apart are no pair in the first steps.",
       Range{0.01, 10.0},
       {"A registration stays where the search put it.", "It is pulled towards other walls."}},
      {"fine_gate_m",
       &C::fine_gate_m,
       "Surfels farther apart are no pair in the last steps.",
       Range{0.01, 10.0},
       {"Few pairs are left, and the closure is weak.",
        "Surfels of other walls bend the closure."}},
      {"surfel_sigma_m",
       &C::surfel_sigma_m,
       "One sigma of the distance of two surfels of one wall, across the wall.",
       kPositive,
       {"Closures claim to be surer than they are and bend the graph.",
        "Closures weigh too little to correct the drift."}},
      {"independent_spacing_m",
       &C::independent_spacing_m,
       "Surfels nearer than this on a wall share their error.",
       kPositive,
       {"Closures claim to be surer than they are.", "Closures weigh too little."}},
  };
}

FieldTable<RevisitConfig> revisit_fields() {
  using C = RevisitConfig;
  return with_nested<C>(
      {
          {"search_cell_m",
           &C::search_cell_m,
           "Step of the search and cell of its grid.",
           Range{0.02, 5.0},
           {"Searches take long and are given up.", "Narrow places are missed."}},
          {"min_window_m",
           &C::min_window_m,
           "Half width of the smallest window that is searched.",
           kPositive,
           {"A revisit just outside is missed.", "Searches take long."}},
          {"max_window_m",
           &C::max_window_m,
           "Half width of the largest window that is searched.",
           Range{0.1, 200.0},
           {"A drive that has drifted farther finds no revisit.",
            "Searches take long, and look-alikes are found."}},
          {"astray_window_m",
           &C::astray_window_m,
           "Half width of the window where the heading is not known.",
           kPositive,
           {"A vehicle that lost its way does not find itself.", "Searches take long."}},
      },
      "registration", &C::registration, registration_fields());
}

FieldTable<LoopClosingConfig> all_fields() {
  using C = LoopClosingConfig;
  FieldTable<C> table = {
      {"min_travel_between_m",
       &C::min_travel_between_m,
       "Driven since the earlier submap; less is no revisit.",
       kNotNegative,
       {"A submap is tied to the one just left, which tells nothing new.",
        "Small loops are not closed."}},
      {"max_distance_m",
       &C::max_distance_m,
       "Between the middles of two submaps that may show the same place.",
       kPositive,
       {"Revisits on another lane or corridor are missed.",
        "Searches are spent on submaps that share nothing."}},
      {"max_candidates",
       &C::max_candidates,
       "Searches for one new submap; 0: no loop is closed where the graph knows the way.",
       Range{0, 100},
       {"The right one of several submaps may not be searched.", "Searches take long."}},
      {"sure_within_m",
       &C::sure_within_m,
       "Expected at least as surely as this (one sigma), one match is enough.",
       kNotNegative,
       {"Loops close late, after several submaps agree.",
        "A single look-alike closes a wrong loop."}},
  };
  table = with_nested(std::move(table), "place", &C::place, place_fields());
  table = with_nested(std::move(table), "revisit", &C::revisit, revisit_fields());
  return config::in_group(config::Group::closing, std::move(table));
}

}  // namespace

const FieldTable<LoopClosingConfig>& loop_closing_fields() {
  static const FieldTable<LoopClosingConfig> table = all_fields();
  return table;
}

}  // namespace slammot::loop_closing
