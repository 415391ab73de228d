#include "common/graphs/path_uncertainty.hpp"

#include <cmath>
#include <functional>
#include <queue>
#include <tuple>
#include <vector>

namespace slammot::graphs {
namespace {

using flow::SubmapId;
using geometry::UncertainPose2;

struct Step {
  SubmapId to;
  UncertainPose2 from_to;
};

double position_sigma_m(const UncertainPose2& pose) { return std::sqrt(pose.covariance.topLeftCorner<2, 2>().trace()); }

std::map<SubmapId, std::vector<Step>> steps_both_ways(std::span<const flow::Constraint> constraints) {
  std::map<SubmapId, std::vector<Step>> steps;
  for (const flow::Constraint& constraint : constraints) {
    steps[constraint.from].push_back({constraint.to, constraint.from_to});
    steps[constraint.to].push_back({constraint.from, geometry::inverse(constraint.from_to)});
  }
  return steps;
}

}  // namespace

std::map<SubmapId, UncertainPose2> poses_along_best_paths(SubmapId root, std::span<const flow::Constraint> constraints) {
  const auto steps = steps_both_ways(constraints);
  std::map<SubmapId, UncertainPose2> root_from_node;
  struct Reached {
    double sigma_m;
    SubmapId node;
    UncertainPose2 root_from_node;
    // By id where equally uncertain, so that the order never depends on the queue.
    bool operator>(const Reached& other) const {
      return std::tie(sigma_m, node) > std::tie(other.sigma_m, other.node);
    }
  };
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
  queue.push({0.0, root, {}});
  while (!queue.empty()) {
    const Reached reached = queue.top();
    queue.pop();
    if (!root_from_node.emplace(reached.node, reached.root_from_node).second) continue;
    const auto found = steps.find(reached.node);
    if (found == steps.end()) continue;
    for (const Step& step : found->second) {
      if (root_from_node.contains(step.to)) continue;
      const UncertainPose2 next = geometry::compound(reached.root_from_node, step.from_to);
      queue.push({position_sigma_m(next), step.to, next});
    }
  }
  return root_from_node;
}

}  // namespace slammot::graphs
