#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <vector>

#include "common/flow/graph_correction.hpp"
#include "common/geometry/uncertain_pose2.hpp"

namespace slammot::graphs {

/// Where every node reachable from `root` lies in root's frame, chained along the path of least uncertainty (smallest
/// standard deviation of the position; Dijkstra). One path ignores what the others add, so the covariance is an upper
/// bound of the graph's own: right for gates, cheap, and free of the whole graph's inversion.
std::map<flow::SubmapId, geometry::UncertainPose2> poses_along_best_paths(flow::SubmapId root,
                                                                          std::span<const flow::Constraint> constraints);

/// Constraints along that path between two nodes, as places in `constraints`, from the goal back; none where there is no path.
std::vector<std::size_t> best_path(flow::SubmapId root, flow::SubmapId goal, std::span<const flow::Constraint> constraints);

}  // namespace slammot::graphs
