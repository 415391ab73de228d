#pragma once

#include "common/graphs/pose_graph.hpp"
#include "services/loop_closing/place.hpp"
#include "services/loop_closing/revisit.hpp"
#include "services/loop_closing/search_queue.hpp"

namespace slammot::loop_closing {

/// What submaps show, numbered as in slammot.proto.
enum class Surroundings { streets, building };

/// Defaults are for road vehicles.
struct LoopClosingConfig {
  Surroundings surroundings = Surroundings::streets;  ///< Set by set_surroundings().
  double min_travel_between_m = 200.0;  ///< Least distance driven since the earlier submap.
  double max_distance_m = 60.0;   ///< Greatest distance between the centres of two submaps that may
                                  ///< show the same place.
  double sure_within_m = 5.0;     ///< One match suffices if the one-sigma error of the expected
                                  ///< position is smaller.
  int needed_support = 2;         ///< Submaps that must agree otherwise.
  int needed_when_ambiguous = 3;  ///< Submaps that must agree where other places fit nearly as
                                  ///< well.
  int most_targets_elsewhere = 40;  ///< Submaps of other islands that one new submap is searched
                                    ///< for on.
  PlaceConfig place;
  RevisitConfig revisit;
  SearchBudget search;
  graphs::PoseGraphConfig graph;
};

}  // namespace slammot::loop_closing
