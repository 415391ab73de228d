#include "common/graphs/path_uncertainty.hpp"

#include <cmath>
#include <functional>
#include <queue>
#include <tuple>
#include <vector>

#include "common/geometry/unscented.hpp"

namespace slammot::graphs {
namespace {

using flow::SubmapId;
using geometry::UncertainPose2;

struct Step {
  SubmapId to;
  UncertainPose2 from_to;
  std::size_t constraint;
};

double position_sigma_m(const UncertainPose2& pose) {
  return std::sqrt(pose.covariance.topLeftCorner<2, 2>().trace());
}

std::map<SubmapId, std::vector<Step>> steps_both_ways(
    std::span<const flow::Constraint> constraints) {
  std::map<SubmapId, std::vector<Step>> steps;
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    const flow::Constraint& constraint = constraints[i];
    steps[constraint.from].push_back({constraint.to, constraint.from_to, i});
    steps[constraint.to].push_back({constraint.from, geometry::inverse(constraint.from_to), i});
  }
  return steps;
}

struct Arrival {
  UncertainPose2 root_from_node;
  SubmapId before;
  std::size_t constraint = 0;  ///< Index of the constraint from the previous node.
};

std::map<SubmapId, Arrival> arrivals_from(SubmapId root,
                                          std::span<const flow::Constraint> constraints) {
  const auto steps = steps_both_ways(constraints);
  std::map<SubmapId, Arrival> arrivals;
  struct Reached {
    double sigma_m;
    SubmapId node;
    Arrival arrival;
    // Ties are broken by id, so that the order is deterministic.
    bool operator>(const Reached& other) const {
      return std::tie(sigma_m, node) > std::tie(other.sigma_m, other.node);
    }
  };
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
  queue.push({0.0, root, {{}, root}});
  while (!queue.empty()) {
    const Reached reached = queue.top();
    queue.pop();
    if (!arrivals.emplace(reached.node, reached.arrival).second) continue;
    const auto found = steps.find(reached.node);
    if (found == steps.end()) continue;
    for (const Step& step : found->second) {
      if (arrivals.contains(step.to)) continue;
      const UncertainPose2 next =
          geometry::unscented::compound_as_needed(reached.arrival.root_from_node, step.from_to);
      queue.push({position_sigma_m(next), step.to, {next, reached.node, step.constraint}});
    }
  }
  return arrivals;
}

}  // namespace

std::map<SubmapId, UncertainPose2> poses_along_best_paths(
    SubmapId root, std::span<const flow::Constraint> constraints) {
  std::map<SubmapId, UncertainPose2> root_from_node;
  for (const auto& [node, arrival] : arrivals_from(root, constraints))
    root_from_node.emplace(node, arrival.root_from_node);
  return root_from_node;
}

std::vector<std::size_t> best_path(SubmapId root, SubmapId goal,
                                   std::span<const flow::Constraint> constraints) {
  const auto arrivals = arrivals_from(root, constraints);
  std::vector<std::size_t> path;
  for (auto at = arrivals.find(goal); at != arrivals.end() && at->first != root;
       at = arrivals.find(at->second.before))
    path.push_back(at->second.constraint);
  return path;
}

}  // namespace slammot::graphs
