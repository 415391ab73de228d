#pragma once

#include <span>

#include "common/geometry/pose2.hpp"

namespace slammot::graphs {

/// A measured position beside its point in map, in the order of the drive.
struct Fix {
  geometry::Vector2 in_map_m;
  geometry::Vector2 in_enu_m;
  geometry::Matrix2 covariance_m2;  ///< Of the errors that are independent from fix to fix.
  double way_m = 0.0;               ///< Driven since the fix before.
};

/// Errors of fixes beyond their covariance. Each fix is in one of two regimes. Usual: the error
/// drifts about zero (Ornstein and Uhlenbeck). Lasting multipath: it keeps an offset of unknown
/// size, until it ends or the offset jumps. A stretch of lasting multipath thus counts as one
/// measurement with a large error, however many fixes it has.
struct FixErrorModel {
  double usual_sigma_m = 2.0;
  double usual_length_m = 20.0;  ///< Correlation length.
  double lasting_sigma_m = 30.0;
  double lasting_after_m = 300.0;  ///< Mean way until lasting multipath begins,
  double lasting_for_m = 100.0;    ///< and until it ends.
};

/// Likelihood of all fixes, given a pose of the map, and its expansion in that pose.
struct FixLikelihood {
  double logarithm = 0.0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< Of the logarithm, by (x, y [m], heading
                                                       ///< [rad]) of the pose.
  geometry::Matrix3 information = geometry::Matrix3::Zero();
};

/// One pass of a filter over both regimes: their error is a state, mixed by its moments
/// (generalized pseudo-Bayesian, first order: Wang 2004, section 4.3). Gradient and information
/// hold for the regimes' probabilities at this pose.
FixLikelihood likelihood(std::span<const Fix> fixes, const geometry::Pose2& enu_from_map,
                         const FixErrorModel& model);

}  // namespace slammot::graphs
