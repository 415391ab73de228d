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
  double min_travel_between_m = 200.0;  ///< Driven since the earlier submap; less is no revisit.
  double max_distance_m = 60.0;   ///< Between the middles of two submaps that may show the same
                                  ///< place.
  int max_candidates = 3;         ///< Searches for one new submap.
  double sure_within_m = 5.0;     ///< Expected no less surely than this (one sigma), one match is
                                  ///< enough,
  int needed_support = 2;         ///< otherwise so many submaps must agree,
  int needed_when_ambiguous = 3;  ///< or so many.
  PlaceConfig place;
  RevisitConfig revisit;
  SearchBudget search;
  graphs::PoseGraphConfig graph;
};

/// What happened so far; all grow only.
struct LoopClosingCounters {
  std::uint64_t submaps = 0;
  std::uint64_t repeated_submaps = 0;  ///< Known already: ignored.
  std::uint64_t faulty_submaps = 0;    ///< With numbers that are none: ignored.
  std::uint64_t searches = 0;
  std::uint64_t searches_given_up = 0;  ///< Too long, or crowded out by newer ones.
  std::uint64_t search_work = 0;        ///< Cells that they read.
  std::uint64_t hypotheses = 0;         ///< Searches that found something.
  std::uint64_t ambiguous = 0;          ///< Of these, with rivals.
  std::uint64_t inconsistent = 0;       ///< Firm, but against what the graph says: dropped.
  std::uint64_t closures = 0;           ///< Accepted, whatever became of them.
  std::uint64_t withdrawn = 0;          ///< Of these, such as were taken back,
  std::uint64_t came_back = 0;        ///< and of these or of the dropped ones, such as count again.
  std::uint64_t contradictions = 0;   ///< Submaps that do not fit what the graph puts them on.
  std::uint64_t found_elsewhere = 0;  ///< Of these, such as told where a map lies that was tied to
                                      ///< nothing.
  std::uint64_t optimisations = 0;
};

/// By the names of the members, as reports and statuses show them.
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

/// Keeps the graph of submaps and looks for revisits. Wang 2004, section 6.4: gate by covariance,
/// match at several scales, wait where it is ambiguous, and close over submaps as features of three
/// degrees of freedom. Deterministic.
class LoopCloser {
 public:
  explicit LoopCloser(const LoopClosingConfig& config);

  /// Takes a finished submap, looks for earlier ones that show the same place, and says where all
  /// submaps now are. Submaps come once each, in ascending order; one that is known is ignored, and
  /// so is one whose numbers are not finite. One whose tie to the submap before says next to
  /// nothing begins an island of its own: it is searched for everywhere, and lies where that tie
  /// says until it is found.
  flow::GraphCorrection add(const flow::Submap& submap);

  /// At the end of a drive: goes on with searches that wait, gives up what takes too long, and says
  /// where all submaps are.
  flow::GraphCorrection finish();

  /// Whether finish() has anything to do.
  bool has_unfinished_work() const { return !searches_.is_empty() || unsolved_ > 0; }

  /// Whether revisits or odometry tie the newest submap to the first one.
  bool knows_where_it_is() const;

  /// Odometric ones in the order of the drive, then every pair of submaps between which a loop was
  /// proposed, with what became of it.
  std::vector<flow::Constraint> constraints() const;
  const LoopClosingCounters& counters() const { return counters_; }

 private:
  struct Candidate {
    flow::SubmapId id;
    geometry::UncertainPose2 target_from_source;
    double distance_m = 0.0;
  };

  /// A revisit that was proposed to the graph.
  struct Closure {
    flow::Constraint constraint;
    std::size_t edge = 0;  ///< In the graph.
    int group = 0;
  };

  /// Closures between the same stretches of the way stand or fall together (Latif et al., IJRR
  /// 2013).
  struct ClosureGroup {
    int doubts = 0;         ///< Submaps that contradict the map where these put them.
    int confirmations = 0;  ///< Closures of other groups that agree.
  };

  using Islands = std::map<flow::SubmapId, flow::SubmapId>;

  void extend_graph(const flow::Submap& submap);
  void add_constraint(const flow::Constraint& constraint);
  void add_to_islands(const flow::Constraint& constraint);
  std::vector<Candidate> candidates_for(const Place& source) const;
  std::vector<Candidate> candidates_elsewhere_for(const Place& source) const;
  std::vector<Candidate> nearest(std::vector<Candidate> all, int most) const;
  RevisitCandidate search_at(const Candidate& candidate, const Place& source) const;
  Target target_around(flow::SubmapId id, const Place& source) const;
  void look_for_revisits(const Place& source);
  void take(const SearchQueue::Finished& search);
  bool are_rivals(const Hypothesis& a, const Hypothesis& b) const;
  void close_what_is_firm();
  int support_of(const Hypothesis& hypothesis) const;
  geometry::Matrix3 drift_between(flow::SubmapId a, flow::SubmapId b) const;
  bool agree(const Hypothesis& a, const Hypothesis& b) const;
  int needed_support_for(const Hypothesis& hypothesis) const;
  std::map<flow::SubmapId, geometry::UncertainPose2> expectations_from(flow::SubmapId id) const;
  bool close(const Hypothesis& hypothesis);
  bool can_be_solved_later(const flow::Constraint& constraint) const;
  void solve_what_waits();
  int group_for(const flow::Constraint& constraint);
  Closure& propose(const Hypothesis& hypothesis);
  void reject(const Hypothesis& hypothesis, double squared_error, std::string reason);
  void settle(const std::string& what_decided);
  void leave_out_what_costs_most(const graphs::PoseGraph& before);
  void withdraw(Closure& closure, std::string reason);
  void look_at_contradictions(const SearchQueue::Finished& search);
  bool contradicts(flow::SubmapId target, const Place& source) const;
  bool contradicts_around(const Hypothesis& hypothesis) const;
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
  std::vector<flow::Constraint> rejected_;  ///< Never proposed to the graph.
  std::map<int, ClosureGroup> groups_;
  int unsolved_ = 0;  ///< Closures since the last solve.
  std::uint32_t sequence_ = 0;
};

}  // namespace slammot::loop_closing
