#pragma once

#include "common/geometry/uncertain_pose2.hpp"

/// Compounding by the unscented transform (Julier 1999; Wang 2004, section 2.1) in place of the linear one: keeps the
/// second-order terms that a large heading error has. The product chains with the linear one: the headings that it chains
/// are known to 0.1 rad or better, where the two differ by less than 1 % (docs/architecture.md). This is what tests hold
/// that against.
namespace slammot::geometry::unscented {

/// Chains two uncertain poses. cross: covariance of the first with the second, rows of the first.
UncertainPose2 compound(const UncertainPose2& a_from_b, const UncertainPose2& b_from_c, const Matrix3& cross = Matrix3::Zero());

/// b_from_a with its covariance.
UncertainPose2 inverse(const UncertainPose2& a_from_b);

/// b_from_c from two poses that share the frame a.
UncertainPose2 tail_to_tail(const UncertainPose2& a_from_b, const UncertainPose2& a_from_c, const Matrix3& cross = Matrix3::Zero());

}  // namespace slammot::geometry::unscented
