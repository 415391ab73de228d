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

namespace slammot::loop_closing {

/// Defaults are for road vehicles.
struct LoopClosingConfig {
  double min_travel_between_m = 200.0;   ///< Driven since the earlier submap; less is no revisit.
  double max_distance_m = 60.0;          ///< Between the middles of two submaps that may show the same place.
  double gate_sigmas = 3.0;              ///< What the graph's uncertainty adds to that distance.
  int max_candidates = 3;                ///< Searches for one new submap.
  int neighbours = 1;                    ///< Submaps before and after the earlier one that join the target.
  double odometry_sigma_scale = 2.0;     ///< What the odometric constraints' sigmas are multiplied by in the gate.
  double sure_within_m = 5.0;            ///< Expected no less surely than this (one sigma), one match is enough,
  int needed_support = 2;                ///< otherwise so many submaps must agree,
  int needed_when_ambiguous = 3;         ///< or so many.
  int patience_submaps = 6;              ///< How long a hypothesis waits for others that agree.
  double max_squared_error = 16.0;       ///< Chi-square of a closure against what the graph expects, before and after.
  int max_candidates_elsewhere = 60;     ///< Searches for one new submap among those that nothing ties it to yet.
  PlaceConfig place;
  RevisitConfig revisit;
  graphs::PoseGraphConfig graph;
};

/// What happened so far; all grow only.
struct LoopClosingCounters {
  std::uint64_t submaps = 0;
  std::uint64_t repeated_submaps = 0;    ///< Known already: ignored.
  std::uint64_t faulty_submaps = 0;      ///< With numbers that are none: ignored.
  std::uint64_t searches = 0;
  std::uint64_t hypotheses = 0;          ///< Searches that found something.
  std::uint64_t ambiguous = 0;           ///< Of these, with rivals.
  std::uint64_t inconsistent = 0;        ///< Firm, but against what the graph says: dropped.
  std::uint64_t closures = 0;
  std::uint64_t found_elsewhere = 0;     ///< Of these, such as told where a map lies that was tied to nothing.
  std::uint64_t optimisations = 0;
};

/// By the names of the members, as reports and statuses show them.
inline std::map<std::string, std::uint64_t> named(const LoopClosingCounters& counters) {
  return {{"submaps", counters.submaps},
          {"repeated_submaps", counters.repeated_submaps},
          {"faulty_submaps", counters.faulty_submaps},
          {"searches", counters.searches},
          {"hypotheses", counters.hypotheses},
          {"ambiguous", counters.ambiguous},
          {"inconsistent", counters.inconsistent},
          {"closures", counters.closures},
          {"found_elsewhere", counters.found_elsewhere},
          {"optimisations", counters.optimisations}};
}

/// Keeps the graph of submaps and looks for revisits. Wang 2004, section 6.4: gate by covariance, match at several
/// scales, wait where it is ambiguous, and close over submaps as features of three degrees of freedom. Deterministic.
class LoopCloser {
 public:
  explicit LoopCloser(const LoopClosingConfig& config);

  /// Takes a finished submap, looks for earlier ones that show the same place, and says where all submaps now are.
  /// Submaps come once each, in ascending order; one that is known is ignored, and so is one whose numbers are not finite.
  /// One whose tie to the submap before says next to nothing begins an island of its own: it is searched for everywhere,
  /// and lies where that tie says until it is found.
  flow::GraphCorrection add(const flow::Submap& submap);

  /// Whether revisits or odometry tie the newest submap to the first one.
  bool knows_where_it_is() const;

  /// All so far, odometric ones and loops, in the order in which they were made.
  const std::vector<flow::Constraint>& constraints() const { return graph_.constraints(); }
  const LoopClosingCounters& counters() const { return counters_; }

 private:
  struct Candidate {
    flow::SubmapId id;
    geometry::UncertainPose2 target_from_source;
    double distance_m = 0.0;
  };

  using Islands = std::map<flow::SubmapId, flow::SubmapId>;

  void extend_graph(const flow::Submap& submap);
  Islands islands_now() const { return islands(graph_.nodes(), graph_.constraints()); }
  std::vector<Candidate> candidates_for(const Place& source) const;
  std::vector<Candidate> candidates_elsewhere_for(const Place& source) const;
  Target target_around(flow::SubmapId id, const Place& source) const;
  void look_for_revisits(const Place& source);
  void look_elsewhere(const Place& source);
  bool are_rivals(const Hypothesis& a, const Hypothesis& b, const Islands& on) const;
  void close_what_is_firm();
  int support_of(const Hypothesis& hypothesis) const;
  bool agree(const Hypothesis& a, const Hypothesis& b) const;
  int needed_support_for(const Hypothesis& hypothesis) const;
  std::map<flow::SubmapId, geometry::UncertainPose2> expectations_from(flow::SubmapId id) const;
  bool close(const Hypothesis& hypothesis);
  void join_islands(const Hypothesis& hypothesis, const Islands& on);
  flow::GraphCorrection correction();

  LoopClosingConfig config_;
  LoopClosingCounters counters_;
  std::map<flow::SubmapId, Place> places_;
  double travelled_m_ = 0.0;
  graphs::PoseGraph graph_;
  RevisitFinder finder_;
  std::vector<Hypothesis> waiting_;
  std::uint32_t sequence_ = 0;
};

}  // namespace slammot::loop_closing
