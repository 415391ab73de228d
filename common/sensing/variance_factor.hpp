#pragma once

#include "common/geometry/uncertain_pose2.hpp"

namespace slammot::sensing {

/// By how much the squared surprises of the matches exceed what the filter expects of them, forward, to the left and in
/// heading: the a-posteriori variance of unit weight of adjustment theory. The filter's noises are chosen for good
/// weights and robustness; this makes the covariance that is published fit the errors that are seen. It does not change
/// any estimate.
struct VarianceFactors {
  Eigen::Vector3d of_axis = Eigen::Vector3d::Ones();
};

/// After one more match, which took `predicted` for its prior. The last match counts for `share`, in (0, 1].
/// Both poses in the same frame. An axis on which the match said nothing keeps its factor.
VarianceFactors learned(const VarianceFactors& factors, const geometry::UncertainPose2& predicted,
                        const geometry::UncertainPose2& matched, double share);

/// The covariance of a pose, in the frame of the pose, with its axes along and across the vehicle scaled.
geometry::Matrix3 scaled(const geometry::UncertainPose2& pose, const VarianceFactors& factors);

}  // namespace slammot::sensing
