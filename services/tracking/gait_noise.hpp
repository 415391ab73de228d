#pragma once

#include <optional>

#include <Eigen/Core>

#include "services/tracking/road_users.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// How far a pedestrian's centre is from the middle of the visible echoes: far for legs, little for
/// a coat. Scales the published covariance only; gates use the configured noise, since they must
/// pass the step of two pedestrians who meet.
struct GaitNoise {
  std::optional<double> variance_m2;  ///< Along each axis; none before the first measurement.
};

/// Time after which the error of the gait has faded to 1/e: docs/decisions/motion-models.md.
inline constexpr double kGaitMemoryS = 0.12;

/// One sigma of the distance of a pedestrian's centre from the middle of the visible legs: 0.1 m
/// for people (docs/decisions/motion-models.md).
inline double gait_sigma_m(const TrackingConfig& config) {
  constexpr double kSizeOverGait = 10.0;  // 1 m / 0.1 m
  return config.extent.size_scale / kSizeOverGait;
}

/// Variance along each axis that the gait adds to a centre measured after_s (> 0) after the one
/// before. The errors fade exponentially, but the filter takes scans for independent: the closer
/// they follow each other, the more each one adds, so that the mean of many is as uncertain as it
/// is.
double gait_variance_m2(double after_s, const TrackingConfig& config);

/// One scan later: innovation of the centre, and the noise of its measurement without the gait.
GaitNoise with_step(const GaitNoise& before, const Eigen::Vector2d& innovation_m,
                    const Eigen::Matrix2d& noise_m2, double time_s, const TrackingConfig& config);

/// Sigma of the gait relative to the configured one, as measured, or as that of the pedestrians
/// seen before.
double gait_share(const GaitNoise& gait, const RoadUsers& road_users, const TrackingConfig& config);

}  // namespace slammot::tracking
