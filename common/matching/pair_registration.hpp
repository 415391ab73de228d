#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/uncertain_pose2.hpp"
#include "common/matching/point_to_line.hpp"
#include "common/matching/scan_pair.hpp"

namespace slammot::matching {

/// Points of a scan in the laser's frame [m], at most about so many and, where it has as many
/// echoes, at least half as many; none beyond 30 m.
std::vector<Eigen::Vector2f> points_of(const std::vector<float>& ranges, const AssumedBeams& beams,
                                       double unit_m, std::size_t most);

/// Motion of the laser between the two scans of a pair, by registering all points of the second
/// one to the surfaces of the first. prior: of that motion.
PointToLineResult register_pair(PointToLineMatcher& matcher, const ScanPair& pair,
                                const AssumedBeams& beams, double unit_m,
                                const geometry::UncertainPose2& prior);

}  // namespace slammot::matching
