#pragma once

#include "common/geometry/uncertain_pose2.hpp"

namespace slammot::sensing {

/// Ratio of the matches' mean squared innovations to the filter's expectation, for the axes
/// forward, left and heading: the a-posteriori variance of unit weight of adjustment theory. The
/// filter's noise is tuned for weights and robustness; these factors make the published covariance
/// consistent. They do not change any estimate.
struct VarianceFactors {
  Eigen::Vector3d of_axis = Eigen::Vector3d::Ones();
  /// Share of each axis' variance that has accumulated since the last match that observed the axis.
  /// Innovations of matches do not inform on the error of dead reckoning.
  Eigen::Vector3d dead_reckoned = Eigen::Vector3d::Zero();
};

/// Factors after one more match with prior `predicted`. The last match has weight `share` in (0,
/// 1]. Both poses are in the same frame. An axis that the match did not observe keeps its factor.
VarianceFactors learned(const VarianceFactors& factors, const geometry::UncertainPose2& predicted,
                        const geometry::UncertainPose2& matched, double share);

/// Updates the dead-reckoned shares from the pose at one scan, the prediction for the next, and the
/// match there (the prediction if there was no match). All poses are in one frame. The heading has
/// no such share, nor has the lateral axis while the heading is not observed. The filter's heading
/// noise is wide, to let the match dominate, and dead reckoning is far better than that noise.
VarianceFactors carried(const VarianceFactors& factors, const geometry::UncertainPose2& before,
                        const geometry::UncertainPose2& predicted,
                        const geometry::UncertainPose2& matched);

/// Error model of one axis of a published pose, as shares of the filter's variance. The error that
/// scan and map share stays constant while the same part of the map is in view, and does not affect
/// the motion. It changes with the distance, as another part comes into view. The error of each
/// scan is independent of the distance.
struct AxisError {
  double of_scan = 0.0;  ///< Error of each single scan, if residuals equal the scanner's noise.
  double of_surprises = 1.0;  ///< Multiple of the innovation factor: map error that changes with
                              ///< the part in view.
  double of_map = 0.0;  ///< Additional map error that residuals cannot show, because map and scan
                        ///< share it; at residuals of the noise.
  double view_m = 1.0;  ///< Distance after which half of the map that determines the axis is
                        ///< replaced.
};

struct PoseErrors {
  AxisError forward;
  AxisError sideways;
  AxisError heading;
};

/// Change of the map in view.
struct MapChange {
  double way_m = 0.0;  ///< Distance driven in the interval over which published poses are compared.
  double squared_residuals = 1.0;  ///< Mean squared residual after the match, as a multiple of that
                                   ///< by the scanner's noise.
};

/// Factors for publication: learned factors and map error for the matched share, 1 for the
/// dead-reckoned share.
VarianceFactors published(const VarianceFactors& factors, const PoseErrors& errors,
                          const MapChange& change);

/// Covariance of a pose, in the pose's frame, scaled along and across the vehicle.
geometry::Matrix3 scaled(const geometry::UncertainPose2& pose, const VarianceFactors& factors);

}  // namespace slammot::sensing
