#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/flow/graph_correction.hpp"
#include "common/flow/submap.hpp"
#include "common/graphs/pose_graph.hpp"
#include "services/loop_closing/islands.hpp"
#include "services/loop_closing/place.hpp"
#include "services/loop_closing/revisit.hpp"
#include "services/loop_closing/search_queue.hpp"

namespace slammot::loop_closing {

/// Defaults are for road vehicles.
struct LoopClosingConfig {
  double min_travel_between_m = 200.0;  ///< Least distance driven since the earlier submap.
  double max_distance_m = 60.0;   ///< Greatest distance between the centres of two submaps that may
                                  ///< show the same place.
  int max_candidates = 3;         ///< Searches per new submap.
  double sure_within_m = 5.0;     ///< One match suffices if the one-sigma error of the expected
                                  ///< position is smaller.
  int needed_support = 2;         ///< Submaps that must agree otherwise.
  int needed_when_ambiguous = 3;  ///< Submaps that must agree where other places fit nearly as
                                  ///< well.
  PlaceConfig place;
  RevisitConfig revisit;
  SearchBudget search;
  graphs::PoseGraphConfig graph;
};

/// Counts since the start.
struct LoopClosingCounters {
  std::uint64_t submaps = 0;
  std::uint64_t repeated_submaps = 0;  ///< Id already known: ignored.
  std::uint64_t faulty_submaps = 0;    ///< With NaN or infinite values: ignored.
  std::uint64_t searches = 0;
  std::uint64_t searches_given_up = 0;  ///< Budget exceeded, or displaced by newer searches.
  std::uint64_t search_work = 0;        ///< Cells read.
  std::uint64_t hypotheses = 0;         ///< Searches with a match.
  std::uint64_t ambiguous = 0;          ///< Of these, with competing poses.
  std::uint64_t inconsistent = 0;    ///< With enough support but contradicting the graph: rejected.
  std::uint64_t closures = 0;        ///< Accepted, including those withdrawn later.
  std::uint64_t withdrawn = 0;       ///< Accepted closures that were withdrawn.
  std::uint64_t came_back = 0;       ///< Rejected or withdrawn closures that were accepted again.
  std::uint64_t contradictions = 0;  ///< Submaps whose walls disagree with the map at the pose that
                                     ///< the graph gives them.
  std::uint64_t found_elsewhere = 0;  ///< Closures that joined two islands.
  std::uint64_t optimisations = 0;
};

/// Counters by member name, for reports and status messages.
inline std::map<std::string, std::uint64_t> named(const LoopClosingCounters& counters) {
  return {{"submaps", counters.submaps},
          {"repeated_submaps", counters.repeated_submaps},
          {"faulty_submaps", counters.faulty_submaps},
          {"searches", counters.searches},
          {"searches_given_up", counters.searches_given_up},
          {"search_work", counters.search_work},
          {"hypotheses", counters.hypotheses},
          {"ambiguous", counters.ambiguous},
          {"inconsistent", counters.inconsistent},
          {"closures", counters.closures},
          {"withdrawn", counters.withdrawn},
          {"came_back", counters.came_back},
          {"contradictions", counters.contradictions},
          {"found_elsewhere", counters.found_elsewhere},
          {"optimisations", counters.optimisations}};
}

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

  /// True if finish() has work to do.
  bool has_unfinished_work() const { return !searches_.is_empty() || unsolved_ > 0; }

  /// True if constraints connect the newest submap to the first one.
  bool is_connected() const;

  /// Odometric constraints in the order of the drive, then every pair of submaps with a proposed
  /// closure and its verdict.
  std::vector<flow::Constraint> constraints() const;
  const LoopClosingCounters& counters() const { return counters_; }

 private:
  struct Candidate {
    flow::SubmapId id;
    geometry::UncertainPose2 target_from_source;
    double distance_m = 0.0;
  };

  /// A closure in the graph, enabled or not.
  struct Closure {
    flow::Constraint constraint;
    std::size_t edge = 0;  ///< Index in graph_.constraints().
    int group = 0;
  };

  /// Closures between the same two stretches of the trajectory; accepted or withdrawn together
  /// (Latif et al., IJRR 2013).
  struct ClosureGroup {
    int contradictions = 0;  ///< Submaps that contradict the map at the pose that this group
                             ///< implies.
    int confirmations = 0;   ///< Closures of other groups that agree.
  };

  using Islands = std::map<flow::SubmapId, flow::SubmapId>;

  void extend_graph(const flow::Submap& submap);
  void add_constraint(const flow::Constraint& constraint);
  void add_to_islands(const flow::Constraint& constraint);
  std::vector<Candidate> candidates_for(const Place& source) const;
  std::vector<Candidate> candidates_elsewhere_for(const Place& source) const;
  std::vector<Candidate> nearest(std::vector<Candidate> all, int most) const;
  RevisitCandidate revisit_candidate(const Candidate& candidate, const Place& source) const;
  Target target_around(flow::SubmapId id, const Place& source) const;
  void begin_searches(const Place& source);
  void take(const SearchQueue::Finished& search);
  bool are_rivals(const Hypothesis& a, const Hypothesis& b) const;
  void close_supported();
  int support_of(const Hypothesis& hypothesis) const;
  geometry::Matrix3 drift_between(flow::SubmapId a, flow::SubmapId b) const;
  bool agree(const Hypothesis& a, const Hypothesis& b) const;
  int needed_support_for(const Hypothesis& hypothesis) const;
  std::map<flow::SubmapId, geometry::UncertainPose2> expectations_from(flow::SubmapId id) const;
  bool close(const Hypothesis& hypothesis);
  bool can_defer_solving(const flow::Constraint& constraint) const;
  void solve_deferred();
  int group_for(const flow::Constraint& constraint);
  Closure& propose(const Hypothesis& hypothesis);
  void reject(const Hypothesis& hypothesis, double squared_error, std::string reason);
  void update_verdicts(const std::string& reason);
  void exclude_costliest_closures(const graphs::PoseGraph& before);
  void withdraw(Closure& closure, std::string reason);
  void check_contradiction(const SearchQueue::Finished& search);
  bool contradicts(flow::SubmapId target, const Place& source) const;
  bool preceding_submaps_contradict(const Hypothesis& hypothesis) const;
  std::vector<int> groups_between(flow::SubmapId a, flow::SubmapId b) const;
  double error_of(const flow::Constraint& constraint) const {
    return graphs::squared_error(constraint, graph_.map_from_node(constraint.from),
                                 graph_.map_from_node(constraint.to));
  }
  std::vector<flow::Constraint> active_constraints() const;
  void join_islands(const Hypothesis& hypothesis);
  flow::GraphCorrection correction();

  LoopClosingConfig config_;
  LoopClosingCounters counters_;
  std::map<flow::SubmapId, Place> places_;
  double travelled_m_ = 0.0;
  graphs::PoseGraph graph_;
  Islands island_of_;
  SearchQueue searches_;
  std::vector<Hypothesis> waiting_;
  std::vector<Closure> closures_;
  std::vector<flow::Constraint> rejected_;  ///< Rejected before they entered the graph.
  std::map<int, ClosureGroup> groups_;
  int unsolved_ = 0;  ///< Closures since the last solve.
  std::uint32_t sequence_ = 0;
};

}  // namespace slammot::loop_closing
