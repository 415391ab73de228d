#pragma once

#include <string>
#include <vector>

#include "common/flow/localized_scan.hpp"
#include "foxglove.pb.h"

namespace slammot::gateway {

/// Pose of the vehicle in map.
foxglove::PoseInFrame pose_message(const flow::LocalizedScan& scan);

/// odom in map, base in odom and the scanner in base, at the scan's stamp.
foxglove::FrameTransforms transforms_message(const flow::LocalizedScan& scan);

/// Poses in map.
foxglove::PosesInFrame poses_message(std::int64_t stamp_ns,
                                     const std::vector<geometry::Pose2>& map_from_base);

/// What the page needs of a localized scan beyond its points, as JSON: pose in odom with its
/// covariance, in the submap, map_from_odom, speeds, identities of map, odom and submap.
std::string pose_json(const flow::LocalizedScan& scan);

}  // namespace slammot::gateway
