#pragma once

#include <Eigen/Core>

#include "common/filters/motion_models.hpp"
#include "common/flow/segmented_scan.hpp"
#include "services/tracking/body.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// Pose uncertainty as it moves a point at this place; Wang 2004, Eq. (2.3).
Eigen::Matrix2d pose_covariance_at(const Eigen::Vector2d& point_in_odom_m, const flow::SegmentedScan& scan);

/// A segment that could not be a whole object of its own, but of which a part may be one.
bool is_backdrop(const flow::Segment& segment, const TrackingConfig& config);

/// Of a track to which no segment is given, in the unit of pair_cost().
inline constexpr double kCostOfLeavingOut = 25.0;

/// Cost of holding the segment for (a part of) a body that moves so; kForbidden outside the gate. Wang 2004, Eq. (5.7) and
/// (5.10) without its constant: squared distance plus the logarithm of the spread, and what speaks against the pair.
double pair_cost(const Body& body, const filters::MotionState& motion, const flow::Segment& segment, const TrackingConfig& config);

}  // namespace slammot::tracking
