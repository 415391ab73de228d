#pragma once

#include <Eigen/Core>

#include "common/filters/motion_models.hpp"
#include "common/flow/segmented_scan.hpp"
#include "services/tracking/extent.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// Covariance of the vehicle's pose as it moves a point at this place; Wang 2004, Eq. (2.3).
Eigen::Matrix2d pose_covariance_at(const Eigen::Vector2d& point_in_odom_m,
                                   const flow::SegmentedScan& scan);

/// True for a segment too large to be an object of its own, of which a part may be one.
bool is_backdrop(const flow::Segment& segment, const TrackingConfig& config);

/// Cost of a track without a segment, in the unit of association_cost().
inline constexpr double kCostOfMiss = 25.0;

/// Cost of the segment as (a part of) an object with this extent and motion; kForbidden outside the
/// gate. Wang 2004, Eqs. (5.7) and (5.10) without the constant: squared Mahalanobis distance,
/// logarithm of the spread, distance from the centre, excess of size, and the label.
double association_cost(const Outline& outline, const filters::MotionState& motion,
                        const flow::Segment& segment, const TrackingConfig& config);

}  // namespace slammot::tracking
