#include "services/loop_closing/loop_closing_fields.hpp"

namespace slammot::loop_closing {
namespace {

using config::FieldTable;
using config::kNotNegative;
using config::kPositive;
using config::kShare;
using config::Range;
using config::with_nested;

FieldTable<PlaceConfig> place_fields() {
  using C = PlaceConfig;
  return {
      {"least_echoes", &C::least_echoes, "A surfel with fewer echoes may be anything and is left out.", kNotNegative},
      {"occupied_log_odds", &C::occupied_log_odds, "From here on a cell of a submap counts as occupied.", Range{0.01, 7.9}},
      {"free_log_odds", &C::free_log_odds, "With this much against it a cell counts as free.", Range{0.01, 7.9}},
      {"tolerance_m", &C::tolerance_m, "A wall this far off still is that wall.", Range{0.0, 5.0}},
  };
}

FieldTable<RegistrationConfig> registration_fields() {
  using C = RegistrationConfig;
  return {
      {"coarse_steps", &C::coarse_steps, "Gauss-Newton steps with the wide gate.", Range{0, 100}},
      {"fine_steps", &C::fine_steps, "Gauss-Newton steps with the narrow gate.", Range{1, 100}},
      {"coarse_gate_m", &C::coarse_gate_m, "Surfels farther apart are no pair in the first steps.", Range{0.01, 10.0}},
      {"fine_gate_m", &C::fine_gate_m, "Surfels farther apart are no pair in the last steps.", Range{0.01, 10.0}},
      {"surfel_sigma_m", &C::surfel_sigma_m, "One sigma of the distance of two surfels of one wall, across the wall.", kPositive},
      {"independent_spacing_m", &C::independent_spacing_m, "Surfels nearer than this on a wall share their error.", kPositive},
      {"position_floor_m", &C::position_floor_m, "No closure is surer of the position than this, one sigma.", kPositive},
      {"heading_floor_rad", &C::heading_floor_rad, "No closure is surer of the heading than this, one sigma.", kPositive},
  };
}

FieldTable<RevisitConfig> revisit_fields() {
  using C = RevisitConfig;
  return with_nested<C>(
      {
          {"search_cell_m", &C::search_cell_m, "Step of the search and cell of its grid.", Range{0.02, 5.0}},
          {"min_score", &C::min_score, "Least score of the search before refinement.", kShare},
          {"max_peaks", &C::max_peaks, "Poses of one search that are looked at.", Range{1, 50}},
          {"max_points", &C::max_points, "Surfels of the new submap that take part in the search.", Range{50, 20000}},
          {"window_sigmas", &C::window_sigmas, "How far around the expected pose is searched.", kPositive},
          {"min_window_m", &C::min_window_m, "Half width of the smallest window.", kPositive},
          {"max_window_m", &C::max_window_m, "Half width of the largest window.", Range{0.1, 200.0}},
          {"min_window_rad", &C::min_window_rad, "Half width of the smallest window of the heading.", kPositive},
          {"max_window_rad", &C::max_window_rad, "Half width of the largest window of the heading.", Range{0.001, 3.15}},
          {"any_heading_sigma_rad", &C::any_heading_sigma_rad, "Less sure of the heading than this, all of the circle is searched.", kPositive},
          {"astray_window_m", &C::astray_window_m, "And at most so far around.", kPositive},
          {"min_overlap_share", &C::min_overlap_share, "Of the new submap's walls, those that the earlier one has too.", kShare},
          {"min_agreed_share", &C::min_agreed_share, "Of the walls of either, those that the other has not seen free.", kShare},
          {"min_agreed_in_support", &C::min_agreed_in_support, "Searched for everywhere, so much still supports another that agrees.", kShare},
          {"rival_ratio", &C::rival_ratio, "Another pose as good as this share of the best makes it ambiguous.", kShare},
      },
      "registration", &C::registration, registration_fields());
}

FieldTable<graphs::PoseGraphConfig> graph_fields() {
  using C = graphs::PoseGraphConfig;
  return {
      {"loop_loss_scale", &C::loop_loss_scale, "Sigmas beyond which a closure does not count; 0 means that all count.", kNotNegative},
      {"max_iterations", &C::max_iterations, "Of one linearized solve.", Range{1, 10000}},
      {"most_work", &C::most_work, "Constraints times iterations of one optimisation.", Range{100.0, 1e12}},
  };
}

FieldTable<SearchBudget> search_fields() {
  using C = SearchBudget;
  return {
      {"work_per_submap", &C::work_per_submap, "Cells that searches read for each submap that comes; about 2 ns each.", Range{1e5, 1e12}},
      {"work_per_search", &C::work_per_search, "A search that has read so many cells is given up.", Range{1e5, 1e12}},
      {"work_at_end", &C::work_at_end, "Cells that searches left at the end of the drive may read.", Range{0.0, 1e12}},
      {"most_waiting", &C::most_waiting, "Searches that wait; more, and the oldest is given up.", Range{1, 1000}},
  };
}

FieldTable<LoopClosingConfig> all_fields() {
  using C = LoopClosingConfig;
  FieldTable<C> table = {
      {"min_travel_between_m", &C::min_travel_between_m, "Driven since the earlier submap; less is no revisit.", kNotNegative},
      {"max_distance_m", &C::max_distance_m, "Between the middles of two submaps that may show the same place.", kPositive},
      {"gate_sigmas", &C::gate_sigmas, "What the graph's uncertainty adds to that distance.", kNotNegative},
      {"max_candidates", &C::max_candidates, "Searches for one new submap.", Range{0, 100}},
      {"neighbours", &C::neighbours, "Submaps before and after the earlier one that join the target.", Range{0, 10}},
      {"odometry_sigma_scale", &C::odometry_sigma_scale, "What the odometric sigmas are multiplied by in the gate.", kPositive},
      {"sure_within_m", &C::sure_within_m, "Expected at least as surely as this (one sigma), one match is enough.", kNotNegative},
      {"needed_support", &C::needed_support, "Submaps that must agree on a closure otherwise.", Range{1, 100}},
      {"needed_when_ambiguous", &C::needed_when_ambiguous, "Submaps that must agree where other poses fit as well.", Range{1, 100}},
      {"patience_submaps", &C::patience_submaps, "How long a hypothesis waits for others that agree.", Range{0, 1000}},
      {"max_candidates_elsewhere", &C::max_candidates_elsewhere, "Targets for one new submap among those that nothing ties it to yet.", Range{0, 10000}},
      {"max_squared_error", &C::max_squared_error, "Chi-square of a closure against the graph before and after.", kPositive},
  };
  table = with_nested(std::move(table), "place", &C::place, place_fields());
  table = with_nested(std::move(table), "revisit", &C::revisit, revisit_fields());
  table = with_nested(std::move(table), "search", &C::search, search_fields());
  return with_nested(std::move(table), "graph", &C::graph, graph_fields());
}

}  // namespace

const FieldTable<LoopClosingConfig>& loop_closing_fields() {
  static const FieldTable<LoopClosingConfig> table = all_fields();
  return table;
}

}  // namespace slammot::loop_closing
