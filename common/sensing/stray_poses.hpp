#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/geometry/pose2.hpp"

namespace slammot::sensing {

/// A pose of odometry that is none of the drive's, between two that are. Places in the sequence.
struct StrayPose {
  std::size_t place = 0;
  std::size_t before = 0;
  std::size_t after = 0;
};

/// Finds poses, alone or two in a row, that lie far from the pose before and the pose after them,
/// while these two are near each other: zeros, a pose of long ago, a spike. In order of place.
///
/// Far: by more than twice the step or turn that nine of ten poses make, so that a robot that
/// turns to and fro from one pose to the next is none. A jump that lasts and odometry that begins
/// anew do not come back. More than one pose in ten is another source rather than an error: none
/// is returned then. wheel_from_base: in order of time, headings in radians, wrapped or not.
std::vector<StrayPose> stray_poses(std::span<const geometry::Pose2> wheel_from_base);

}  // namespace slammot::sensing
