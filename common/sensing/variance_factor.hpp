#pragma once

#include "common/geometry/uncertain_pose2.hpp"

namespace slammot::sensing {

/// By how much the squared surprises of the matches exceed what the filter expects of them, forward, to the left and in
/// heading: the a-posteriori variance of unit weight of adjustment theory. The filter's noises are chosen for good
/// weights and robustness; this makes the covariance that is published fit the errors that are seen. It does not change
/// any estimate.
struct VarianceFactors {
  Eigen::Vector3d of_axis = Eigen::Vector3d::Ones();
  /// Share of each axis' variance that has grown since a match last said anything of it: surprises of matches tell
  /// nothing of how far odometry is off.
  Eigen::Vector3d dead_reckoned = Eigen::Vector3d::Zero();
};

/// After one more match, which took `predicted` for its prior. The last match counts for `share`, in (0, 1].
/// Both poses in the same frame. An axis on which the match said nothing keeps its factor.
VarianceFactors learned(const VarianceFactors& factors, const geometry::UncertainPose2& predicted,
                        const geometry::UncertainPose2& matched, double share);

/// What the pose at one scan, the prediction of it for the next, and the match there (the prediction itself where there
/// was none) make of the dead-reckoned shares. All in one frame. The heading has none, nor does the way sideways while
/// the heading is not observed: the filter's noise of the heading is wide, to let the laser decide, and dead reckoning is far
/// better than that.
VarianceFactors carried(const VarianceFactors& factors, const geometry::UncertainPose2& before, const geometry::UncertainPose2& predicted,
                        const geometry::UncertainPose2& matched);

/// How one axis of a published pose errs, as shares of the filter's variance. What scan and map have in common stays the same as long as the same part of
/// the map is in view, and is none of the motion; with the way, another part comes into view. What each scan has of its own is there at any way.
struct AxisError {
  double of_scan = 0.0;       ///< By which each scan is off, where residuals are the scanner's noise.
  double of_surprises = 1.0;  ///< Times what surprises of matches say, by which another part of the map is off,
  double of_map = 0.0;        ///< and by which it is besides, where residuals are the scanner's noise: they cannot show what the map shares with the scan.
  double view_m = 1.0;        ///< After this way half of what tells of the axis is another part.
};

struct PoseErrors {
  AxisError forward;
  AxisError sideways;
  AxisError heading;
};

/// What of the map is not what was in view before.
struct MapChange {
  double way_m = 0.0;               ///< Of the time over which published poses are to be compared.
  double squared_residuals = 1.0;   ///< Mean square of what is left after the match, of what the scanner's noise would leave.
};

/// Factors with which to publish: of what was matched those learned and the map's error, 1 for what was dead reckoned.
VarianceFactors published(const VarianceFactors& factors, const PoseErrors& errors, const MapChange& change);

/// The covariance of a pose, in the frame of the pose, with its axes along and across the vehicle scaled.
geometry::Matrix3 scaled(const geometry::UncertainPose2& pose, const VarianceFactors& factors);

}  // namespace slammot::sensing
