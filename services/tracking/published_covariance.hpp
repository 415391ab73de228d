#pragma once

#include <Eigen/Core>

#include "services/tracking/track.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// Covariance of the centre by errors common to many scans, which the filter, assuming white noise,
/// does not see: of the assumed size, of the heading along which the centre lies behind the visible
/// sides, and of the shape. heading_rad: of the published box, in odom.
Eigen::Matrix2d common_error_covariance(const Track& track, double heading_rad,
                                        const TrackingConfig& config);

/// Factors of the filter's sigmas of (x, y, vx, vy): the filter assumes the gait of visible legs,
/// and echo errors of rounded bodies.
Eigen::DiagonalMatrix<double, 4> noise_factors(const Track& track, const TrackingConfig& config);

/// Covariance of position and velocity time_s later, at constant velocity.
Eigen::Matrix4d covariance_after(const Eigen::Matrix4d& covariance, double time_s);

}  // namespace slammot::tracking
