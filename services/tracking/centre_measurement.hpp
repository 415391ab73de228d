#pragma once

#include <Eigen/Core>

namespace slammot::tracking {

/// Measured position of an object's centre, in odom.
struct CentreMeasurement {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Identity();
  /// Step of the centre when the box takes its new size while the visible sides stay in place.
  Eigen::Vector2d recentring_m = Eigen::Vector2d::Zero();
  /// Covariance of the step that the centre makes if it is measured from other ends than before:
  /// the error of the size, common to all scans, and not motion.
  Eigen::Matrix2d step_covariance_m2 = Eigen::Matrix2d::Zero();
};

}  // namespace slammot::tracking
