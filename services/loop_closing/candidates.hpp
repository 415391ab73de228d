#pragma once

#include <vector>

#include "services/loop_closing/closure_graph.hpp"
#include "services/loop_closing/loop_closing_config.hpp"
#include "services/loop_closing/place.hpp"
#include "services/loop_closing/revisit.hpp"

namespace slammot::loop_closing {

/// All submaps so far, with their graph and the configuration.
struct SubmapView {
  const LoopClosingConfig& config;
  const Places& places;
  const ClosureGraph& graph;
  bool gnss_is_sound = true;  ///< False if the fixes so far contradict the map.
};

/// An earlier submap and its neighbours as one target for `source`.
Target target_around(const SubmapView& submaps, flow::SubmapId id, const Place& source);

/// Targets on the island of `source` that its expected pose may overlap, nearest first; at most
/// `kMaxCandidates`. Gate by the graph's covariance: Wang 2004, section 6.4.
std::vector<RevisitCandidate> expected_candidates(const SubmapView& submaps, const Place& source);

/// Targets on other islands, nearest first by the last known position of the vehicle.
std::vector<RevisitCandidate> candidates_elsewhere(const SubmapView& submaps, const Place& source);

}  // namespace slammot::loop_closing
