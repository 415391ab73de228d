#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "common/flow/graph_correction.hpp"
#include "common/graphs/pose_graph.hpp"

namespace slammot::loop_closing {

constexpr double kMaxSquaredError = 16.0;  ///< Chi-square of a closure against the graph before and
                                           ///< after it: docs/decisions/loop-closing.md.
constexpr int kSameStretchSubmaps = 6;     ///< Submaps of one stretch differ by at most this.

/// Pose graph of submaps with islands and with verdicts on closures. Closures are weighed at each
/// solve, excluded, withdrawn and accepted again.
class ClosureGraph {
 public:
  /// Counts since the start.
  struct Counters {
    std::uint64_t optimisations = 0;
    std::uint64_t withdrawn = 0;
    std::uint64_t came_back = 0;
  };

  /// State to return to if a proposed closure turns out to be wrong.
  struct Snapshot {
    graphs::PoseGraph graph;
    std::map<flow::SubmapId, flow::SubmapId> island_of;
    std::size_t closures = 0;
  };

  explicit ClosureGraph(const graphs::PoseGraphConfig& config) : graph_(config) {}

  /// Adds a submap as an island of its own. Precondition: the id is new.
  void add_node(flow::SubmapId id, const geometry::Pose2& map_from_node);

  /// Adds a constraint, which joins the islands of its ends.
  void add_constraint(const flow::Constraint& constraint);

  bool contains(flow::SubmapId id) const { return graph_.contains(id); }
  std::size_t size() const { return island_of_.size(); }
  const geometry::Pose2& map_from_node(flow::SubmapId id) const { return graph_.map_from_node(id); }
  std::vector<flow::CorrectedSubmap> nodes() const { return graph_.nodes(); }
  const Counters& counters() const { return counters_; }

  /// Earliest submap of the island.
  flow::SubmapId island_of(flow::SubmapId id) const { return island_of_.at(id); }
  bool are_on_one_island(flow::SubmapId a, flow::SubmapId b) const {
    return island_of(a) == island_of(b);
  }

  /// Moves the whole later island so that the constraint is satisfied: the first submap defines the
  /// frame map.
  void join_islands(const flow::Constraint& constraint);

  /// Chi-square of a constraint against the poses of the graph, 3 degrees of freedom.
  double error_of(const flow::Constraint& constraint) const;

  /// Poses of all submaps of the island relative to `id`, with covariances along the best paths.
  /// Odometric sigmas are scaled: docs/decisions/loop-closing.md.
  std::map<flow::SubmapId, geometry::UncertainPose2> expectations_from(flow::SubmapId id) const;

  /// Odometric constraints in the order of the drive, then every pair of submaps with a proposed
  /// closure and its verdict.
  std::vector<flow::Constraint> constraints() const;

  /// Constraints that hold now: odometric ones and closures that are not excluded.
  std::vector<flow::Constraint> active_constraints() const;

  Snapshot snapshot() const { return {graph_, island_of_, closures_.size()}; }
  void restore(const Snapshot& snapshot);

  /// True if a closure between these two submaps was proposed, whatever its verdict.
  bool is_on_record(flow::SubmapId from, flow::SubmapId to) const;

  /// True if no closure between the same two stretches is accepted.
  bool founds_group(const flow::Constraint& closure) const;

  /// Adds a closure, accepted for now.
  void propose(const flow::Constraint& closure);

  /// Whether an excluded closure supports the newest one.
  using Agrees = std::function<bool(const flow::Constraint&)>;

  /// Enables the excluded closures that agree with the newest one. False if there are none.
  bool enable(const Agrees& agrees);

  /// Records a closure that never entered the graph, or left it by restore().
  void reject(const flow::Constraint& closure, std::string reason);

  /// Optimizes the graph with the closure proposed since `before`. If that distorts it, the
  /// excluded closures that agree are weighed with the newest, and closures are excluded if that
  /// costs less than the distortion of odometry. Otherwise those that agree and fit the new poses
  /// are enabled.
  void solve_since(const Snapshot& before, const Agrees& agrees);

  /// Optimizes the graph and updates the verdicts.
  void solve(const std::string& reason);

  /// True if the last proposed closure has a weight of at least one half.
  bool is_newest_active() const { return is_active(closures_.back()); }

  /// Sets the verdict of each closure from its weight. `reason`: of withdrawals.
  void update_verdicts(const std::string& reason);

  /// Counts a closure in favour of all groups of closures on the path between its ends.
  void confirm_path(flow::SubmapId a, flow::SubmapId b);

  /// Counts a contradiction between the walls of two submaps: some closure on the path between both
  /// is wrong. Withdraws the weakest group on the path after repeated contradictions.
  void contradict_path(flow::SubmapId source, flow::SubmapId target);

 private:
  /// A closure in the graph, enabled or not.
  struct Closure {
    flow::Constraint constraint;
    std::size_t edge = 0;  ///< Index in graph_.constraints().
    int group = 0;
  };

  /// Closures between the same two stretches of the trajectory; accepted or withdrawn together
  /// (Latif et al., IJRR 2013).
  struct Group {
    int contradictions = 0;  ///< Submaps that contradict the map at the pose that this group
                             ///< implies.
    int confirmations = 0;   ///< Closures of other groups that agree.
  };

  bool is_active(const Closure& closure) const { return graph_.weight(closure.edge) >= 0.5; }
  int group_for(const flow::Constraint& closure) const;
  std::vector<int> groups_between(flow::SubmapId a, flow::SubmapId b) const;
  void optimise();
  std::vector<std::size_t> new_edges(const graphs::PoseGraph& before) const;
  graphs::PoseGraph without_group(int group, std::size_t& excluded);
  bool distorts(const graphs::PoseGraph& before) const;
  void exclude_costliest(const graphs::PoseGraph& before);
  void withdraw(Closure& closure, std::string reason);

  graphs::PoseGraph graph_;
  std::map<flow::SubmapId, flow::SubmapId> island_of_;
  std::vector<Closure> closures_;
  std::vector<flow::Constraint> rejected_;
  std::map<int, Group> groups_;
  Counters counters_;
};

}  // namespace slammot::loop_closing
