#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <vector>

#include "common/flow/graph_correction.hpp"
#include "common/geometry/uncertain_pose2.hpp"

namespace slammot::graphs {

/// Pose of every node reachable from `root` in root's frame, along the path of least uncertainty
/// (smallest standard deviation of the position; Dijkstra). A single path ignores the information
/// of the others, so that its covariance is an upper bound of the graph's: safe for gates, and
/// cheap because the graph is not inverted.
std::map<flow::SubmapId, geometry::UncertainPose2> poses_along_best_paths(
    flow::SubmapId root, std::span<const flow::Constraint> constraints);

/// Constraints of that path between two nodes, as indices into `constraints`, from the goal back;
/// none if there is no path.
std::vector<std::size_t> best_path(flow::SubmapId root, flow::SubmapId goal,
                                   std::span<const flow::Constraint> constraints);

}  // namespace slammot::graphs
