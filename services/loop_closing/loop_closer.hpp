#pragma once

#include <cstdint>
#include <vector>

#include "common/flow/graph_correction.hpp"
#include "common/flow/submap.hpp"
#include "services/loop_closing/candidates.hpp"
#include "services/loop_closing/closure_graph.hpp"
#include "services/loop_closing/georeferencing.hpp"
#include "services/loop_closing/loop_closing_config.hpp"
#include "services/loop_closing/loop_closing_counters.hpp"
#include "services/loop_closing/place.hpp"
#include "services/loop_closing/revisit.hpp"
#include "services/loop_closing/search_queue.hpp"

namespace slammot::loop_closing {

/// Maintains the pose graph of submaps and detects revisits. Wang 2004, section 6.4: gate by
/// covariance, match at several scales, defer ambiguous matches, close over submaps as features
/// with three degrees of freedom. Deterministic.
class LoopCloser {
 public:
  explicit LoopCloser(const LoopClosingConfig& config);

  /// Adds a finished submap, searches earlier submaps for the same place and returns the poses of
  /// all submaps. Ids ascend; a repeated id or a submap with non-finite values is ignored. A submap
  /// whose odometric constraint leaves the heading undetermined begins an island: it is searched
  /// for on all other islands and keeps its odometric pose until it is located.
  flow::GraphCorrection add(const flow::Submap& submap);

  /// End of a drive: completes pending searches within the budget, gives up the rest and returns
  /// the poses of all submaps.
  flow::GraphCorrection finish();

  /// Searches once more for the submaps from `first` on, where their corrected poses overlap
  /// earlier submaps that no closure relates them to yet. Finds revisits that were driven through
  /// before their island was located. Call after finish().
  flow::GraphCorrection search_again(flow::SubmapId first);

  /// True if finish() has work to do.
  bool has_unfinished_work() const { return !searches_.is_empty() || unsolved_cost_ > 0.0; }

  /// True if constraints connect the newest submap to the first one.
  bool is_connected() const;

  /// Odometric constraints in the order of the drive, then every pair of submaps with a proposed
  /// closure and its verdict.
  std::vector<flow::Constraint> constraints() const { return graph_.constraints(); }
  const LoopClosingCounters& counters() const { return counters_; }

  /// All submaps so far with their graph; valid until the next change.
  SubmapView submaps() const { return {config_, places_, graph_, gnss_is_sound_}; }

 private:
  void supersede_places_around(const Place& newest);
  void extend_graph(const flow::Submap& submap);
  void begin_expected_searches(const Place& source);
  void begin_searches(const Place& source);
  void take(const SearchQueue::Finished& search);
  void close_supported();
  int needed_support_for(const Hypothesis& hypothesis) const;
  bool close(const Hypothesis& hypothesis);
  bool holds_after_join(const Hypothesis& hypothesis,
                        const std::vector<Hypothesis>& supporters) const;
  bool can_defer_solving(const flow::Constraint& closure) const;
  void solve_deferred();
  void propose(const Hypothesis& hypothesis);
  void check_contradiction(const SearchQueue::Finished& search);
  flow::GraphCorrection correction();
  void georeference(flow::GraphCorrection& correction);

  LoopClosingConfig config_;
  LoopClosingCounters counters_;
  Places places_;
  double travelled_m_ = 0.0;
  ClosureGraph graph_;
  Georeferencing georeferencing_;
  bool gnss_is_sound_ = true;  ///< By the last correction.
  SearchQueue searches_;
  std::vector<Hypothesis> waiting_;
  double unsolved_cost_ = 0.0;  ///< Sum of squared errors of the closures since the last solve.
  std::uint32_t sequence_ = 0;
};

}  // namespace slammot::loop_closing
