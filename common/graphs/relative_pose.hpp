#pragma once

#include "common/geometry/pose2.hpp"

namespace slammot::graphs {

/// A relative pose and its derivatives by the two poses in map, each ordered (x [m], y [m], heading
/// [rad]).
struct RelativePose {
  geometry::Pose2 from_to;
  geometry::Matrix3 by_from;
  geometry::Matrix3 by_to;
};

/// Tail-to-tail relation of two poses: Wang 2004, Eqs. (2.8)-(2.10).
RelativePose relative_pose(const geometry::Pose2& map_from_from,
                           const geometry::Pose2& map_from_to);

}  // namespace slammot::graphs
