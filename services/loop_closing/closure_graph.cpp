#include "services/loop_closing/closure_graph.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <utility>

#include "common/graphs/path_uncertainty.hpp"
#include "services/loop_closing/islands.hpp"

namespace slammot::loop_closing {
namespace {

using flow::ClosureState;
using flow::Constraint;
using flow::ConstraintKind;
using flow::SubmapId;
using geometry::Pose2;
using geometry::UncertainPose2;

constexpr double kOdometrySigmaScale = 2.0;  // docs/decisions/loop-closing.md

}  // namespace

void ClosureGraph::add_node(SubmapId id, const Pose2& map_from_node) {
  graph_.add_node(id, map_from_node);
  island_of_.emplace(id, id);
}

void ClosureGraph::add_constraint(const Constraint& constraint) {
  graph_.add_constraint(constraint);
  const SubmapId a = island_of_.at(constraint.from);
  const SubmapId b = island_of_.at(constraint.to);
  if (a == b) return;
  for (auto& [id, island] : island_of_) {
    if (island == std::max(a, b)) island = std::min(a, b);
  }
}

void ClosureGraph::join_islands(const Constraint& constraint) {
  const bool to_moves = island_of_.at(constraint.from) < island_of_.at(constraint.to);
  const Pose2 map_from_from = graph_.map_from_node(constraint.from);
  const Pose2 map_from_to = graph_.map_from_node(constraint.to);
  const Pose2 shift = to_moves
                          ? map_from_from * constraint.from_to.pose * geometry::inverse(map_from_to)
                          : map_from_to * geometry::inverse(constraint.from_to.pose) *
                                geometry::inverse(map_from_from);
  const SubmapId moving = island_of_.at(to_moves ? constraint.to : constraint.from);
  for (const auto& [id, island] : island_of_) {
    if (island == moving) graph_.move_node(id, shift * graph_.map_from_node(id));
  }
}

double ClosureGraph::error_of(const Constraint& constraint) const {
  return graphs::squared_error(constraint, graph_.map_from_node(constraint.from),
                               graph_.map_from_node(constraint.to));
}

std::map<SubmapId, UncertainPose2> ClosureGraph::expectations_from(SubmapId id) const {
  std::vector<Constraint> widened = active_constraints();
  const double scale = kOdometrySigmaScale * kOdometrySigmaScale;
  for (Constraint& constraint : widened) {
    if (constraint.kind == ConstraintKind::kOdometric) constraint.from_to.covariance *= scale;
  }
  auto expected = graphs::poses_along_best_paths(id, widened);
  // Covariance along the best path; mean from the optimized graph.
  const Pose2 id_from_map = geometry::inverse(graph_.map_from_node(id));
  for (auto& [node, pose] : expected) pose.pose = id_from_map * graph_.map_from_node(node);
  return expected;
}

std::vector<Constraint> ClosureGraph::active_constraints() const {
  std::vector<Constraint> active;
  for (std::size_t i = 0; i < graph_.constraints().size(); ++i) {
    if (graph_.weight(i) >= 0.5) active.push_back(graph_.constraints()[i]);
  }
  return active;
}

std::vector<Constraint> ClosureGraph::constraints() const {
  std::vector<Constraint> all;
  for (const Constraint& constraint : graph_.constraints()) {
    if (constraint.kind == ConstraintKind::kOdometric) all.push_back(constraint);
  }
  std::map<std::pair<SubmapId, SubmapId>, const Constraint*> loops;
  for (const Constraint& constraint : rejected_)
    loops[{constraint.from, constraint.to}] = &constraint;
  for (const Closure& closure : closures_)
    loops[{closure.constraint.from, closure.constraint.to}] = &closure.constraint;
  for (const auto& [ends, constraint] : loops) all.push_back(*constraint);
  return all;
}

void ClosureGraph::restore(const Snapshot& snapshot) {
  graph_ = snapshot.graph;
  island_of_ = snapshot.island_of;
  closures_.erase(closures_.begin() + static_cast<std::ptrdiff_t>(snapshot.closures),
                  closures_.end());
}

int ClosureGraph::group_for(const Constraint& closure) const {
  const auto is_near = [&](SubmapId a, SubmapId b) {
    return std::abs(static_cast<double>(a.value) - b.value) <= kSameStretchSubmaps;
  };
  const auto known = std::ranges::find_if(closures_, [&](const Closure& one) {
    return one.constraint.verdict.state == ClosureState::kAccepted &&
           is_near(one.constraint.from, closure.from) && is_near(one.constraint.to, closure.to);
  });
  return known != closures_.end() ? known->group : static_cast<int>(closures_.size());
}

bool ClosureGraph::is_on_record(SubmapId from, SubmapId to) const {
  const auto relates = [&](const Constraint& one) { return one.from == from && one.to == to; };
  return std::ranges::any_of(rejected_, relates) ||
         std::ranges::any_of(closures_, relates, &Closure::constraint);
}

bool ClosureGraph::founds_group(const Constraint& closure) const {
  return std::ranges::none_of(closures_, [group = group_for(closure)](const Closure& one) {
    return one.group == group && one.constraint.verdict.state == ClosureState::kAccepted;
  });
}

bool ClosureGraph::enable(const Agrees& agrees) {
  bool is_any = false;
  for (const Closure& excluded : closures_) {
    if (excluded.constraint.verdict.state == ClosureState::kAccepted ||
        !agrees(excluded.constraint))
      continue;
    graph_.set_enabled(excluded.edge, true);
    is_any = true;
  }
  return is_any;
}

void ClosureGraph::propose(const Constraint& closure) {
  const int group = group_for(closure);
  Constraint accepted = closure;
  accepted.verdict.state = ClosureState::kAccepted;
  accepted.verdict.squared_error = error_of(closure);
  add_constraint(accepted);
  closures_.push_back({accepted, graph_.constraints().size() - 1, group});
  groups_.try_emplace(group);
}

void ClosureGraph::reject(const Constraint& closure, std::string reason) {
  rejected_.push_back(closure);
  rejected_.back().verdict.state = ClosureState::kRejected;
  rejected_.back().verdict.reason = std::move(reason);
}

void ClosureGraph::optimise() {
  graph_.optimise();
  ++counters_.optimisations;
}

void ClosureGraph::solve(const std::string& reason) {
  optimise();
  update_verdicts(reason);
}

void ClosureGraph::solve_since(const Snapshot& before, const Agrees& agrees) {
  optimise();
  if (!distorts(before.graph)) {
    enable([&](const Constraint& excluded) { return graph_.fits(excluded) && agrees(excluded); });
    return;
  }
  if (enable(agrees)) optimise();
  if (distorts(before.graph)) exclude_costliest(before.graph);
}

/// True if the closures since `before` cost more than to exclude one.
bool ClosureGraph::distorts(const graphs::PoseGraph& before) const {
  return graph_.truncated_cost(kOdometrySigmaScale) >
         before.truncated_cost(kOdometrySigmaScale) + kMaxSquaredError;
}

/// The newest closure and those that it enabled again.
std::vector<std::size_t> ClosureGraph::new_edges(const graphs::PoseGraph& before) const {
  std::vector<std::size_t> edges{closures_.back().edge};
  for (const Closure& closure : closures_) {
    if (closure.edge != edges.front() && before.weight(closure.edge) < 0.5 && is_active(closure))
      edges.push_back(closure.edge);
  }
  return edges;
}

/// The optimized graph without the active closures of a group, whose number is `excluded`.
graphs::PoseGraph ClosureGraph::without_group(int group, std::size_t& excluded) {
  graphs::PoseGraph without = graph_;
  excluded = 0;
  for (const Closure& one : closures_) {
    if (one.group != group || without.weight(one.edge) < 0.5) continue;
    without.set_enabled(one.edge, false);
    ++excluded;
  }
  without.optimise();
  ++counters_.optimisations;
  return without;
}

/// Contradictory closures are more certain than odometry: instead of showing large errors of their
/// own, they distort odometric constraints. Takes the cheapest alternative: exclude the newest
/// closure with those that it re-enabled, or one of the latest groups (truncated least squares over
/// groups).
void ClosureGraph::exclude_costliest(const graphs::PoseGraph& before) {
  constexpr std::size_t kMaxGroups = 3;
  const double price = kMaxSquaredError;
  const auto cost_of = [&](const graphs::PoseGraph& graph) {
    return graph.truncated_cost(kOdometrySigmaScale);
  };
  const std::vector<std::size_t> edges = new_edges(before);
  double least_cost = cost_of(before) + price * static_cast<double>(edges.size());
  graphs::PoseGraph best = before;
  for (const Constraint& constraint :
       std::span(graph_.constraints()).subspan(before.constraints().size()))
    best.add_constraint(constraint);
  for (const std::size_t edge : edges) best.set_enabled(edge, false);
  std::set<int> tried;
  for (auto closure = closures_.rbegin() + 1;
       closure != closures_.rend() && tried.size() < kMaxGroups; ++closure) {
    if (closure->group == closures_.back().group || !is_active(*closure) ||
        !tried.insert(closure->group).second)
      continue;
    std::size_t excluded = 0;
    const graphs::PoseGraph without = without_group(closure->group, excluded);
    const double cost = cost_of(without) + price * static_cast<double>(excluded);
    if (cost >= least_cost) continue;
    least_cost = cost;
    best = without;
  }
  graph_ = best;
}

void ClosureGraph::update_verdicts(const std::string& reason) {
  bool has_changed = false;
  for (Closure& closure : closures_) {
    flow::ClosureVerdict& verdict = closure.constraint.verdict;
    const ClosureState before = verdict.state;
    const bool is_newest = &closure == &closures_.back();
    if (is_active(closure)) {
      if (verdict.state != ClosureState::kAccepted) {
        verdict.reason = "agrees with the graph again";
        ++counters_.came_back;
      }
      verdict.state = ClosureState::kAccepted;
      verdict.squared_error = error_of(closure.constraint);
    } else if (verdict.state == ClosureState::kAccepted && is_newest) {
      verdict.state = ClosureState::kRejected;
      verdict.squared_error = error_of(closure.constraint);
      verdict.reason = "distorts the graph by more than its uncertainty";
      graph_.set_enabled(closure.edge, false);
    } else if (verdict.state == ClosureState::kAccepted) {
      withdraw(closure, reason);
    } else {
      graph_.set_enabled(closure.edge, false);
    }
    has_changed = has_changed || verdict.state != before;
  }
  if (has_changed) island_of_ = islands(graph_.nodes(), active_constraints());
}

void ClosureGraph::withdraw(Closure& closure, std::string reason) {
  closure.constraint.verdict = {ClosureState::kWithdrawn, error_of(closure.constraint),
                                closure.constraint.verdict.agreed_share, std::move(reason)};
  graph_.set_enabled(closure.edge, false);
  ++counters_.withdrawn;
}

std::vector<int> ClosureGraph::groups_between(SubmapId a, SubmapId b) const {
  const std::vector<Constraint> active = active_constraints();
  std::set<int> groups;
  for (const std::size_t step : graphs::best_path(a, b, active)) {
    if (active[step].kind == ConstraintKind::kOdometric) continue;
    const auto closure = std::ranges::find_if(closures_, [&](const Closure& one) {
      return one.constraint.from == active[step].from && one.constraint.to == active[step].to;
    });
    if (closure != closures_.end()) groups.insert(closure->group);
  }
  return {groups.begin(), groups.end()};
}

void ClosureGraph::confirm_path(SubmapId a, SubmapId b) {
  for (const int group : groups_between(a, b)) ++groups_[group].confirmations;
}

void ClosureGraph::contradict_path(SubmapId source, SubmapId target) {
  constexpr int kMaxContradictions = 2;
  const std::vector<int> between = groups_between(source, target);
  if (between.empty()) return;
  const int weakest = std::ranges::min(between, {}, [&](int group) {
    return groups_[group].confirmations - groups_[group].contradictions;
  });
  Group& group = groups_[weakest];
  if (++group.contradictions < kMaxContradictions ||
      group.contradictions <= 2 * group.confirmations)
    return;
  for (Closure& closure : closures_) {
    if (closure.group == weakest && closure.constraint.verdict.state == ClosureState::kAccepted)
      withdraw(closure, "contradicted by submap " + std::to_string(source.value) +
                            " at the pose that this implies");
  }
  group = {};
  island_of_ = islands(graph_.nodes(), active_constraints());
  optimise();
}

}  // namespace slammot::loop_closing
