#pragma once

#include <vector>

#include "common/flow/graph_correction.hpp"
#include "common/flow/submap.hpp"
#include "services/loop_closing/loop_closing_config.hpp"
#include "services/loop_closing/loop_closing_counters.hpp"

namespace slammot::loop_closing {

enum class MergeOutcome {
  kJoined,
  kNoCommonPlace,  ///< No place of the second map was found in the first one.
  kTooFewPlaces,   ///< A place was found, but too few submaps confirm it.
  kContradicted,   ///< Where the maps overlap, walls of one are in free space of the other.
};

/// One map of two with unknown relative start: Wang 2004, section 5.3.3.
struct Merge {
  MergeOutcome outcome = MergeOutcome::kNoCommonPlace;
  int closures = 0;           ///< Accepted ones between the two maps.
  int places = 0;             ///< Submaps of the second map with such a closure.
  int overlapping = 0;        ///< Submaps of the second map that share seen walls with the first.
  int contradicting = 0;      ///< Of these, those whose walls disagree.
  double agreed_share = 0.0;  ///< Of the walls of all of them.
  std::vector<flow::Submap> submaps;  ///< Of both maps, numbered from 0, the first map's first. The
                                      ///< odometric constraint of the second map's first submap is
                                      ///< the relative pose that was found.
  flow::GraphCorrection correction;   ///< In the frame of the first map.
  std::vector<flow::Constraint> constraints;
  LoopClosingCounters counters;
};

/// Searches for every submap of `second` on all submaps of `first`, over all headings, and joins
/// both where several submaps agree with each other, with both graphs and with all walls. Submaps
/// ascend and have equal cell sizes; neither map is empty. Counted work bounds the search:
/// deterministic.
Merge merge_maps(const LoopClosingConfig& config, const std::vector<flow::Submap>& first,
                 const std::vector<flow::Submap>& second);

}  // namespace slammot::loop_closing
