#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "services/tracking/observation.hpp"
#include "services/tracking/track.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// Updates kinematics, extent, consistency and class by an observation at stamp_ns;
/// pose_covariance_m2: of the vehicle's pose at the track. False, and only the heading changed, if
/// a confirmed track rejects the observation as too far from its prediction.
bool update(Track& track, std::int64_t stamp_ns, const Observation& observation,
            const Eigen::Matrix2d& pose_covariance_m2, const TrackingConfig& config);

/// Counts the observation: hits, stamp, contour.
void note_observation(Track& track, std::int64_t stamp_ns, const Observation& observation);

}  // namespace slammot::tracking
