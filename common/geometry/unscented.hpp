#pragma once

#include "common/geometry/uncertain_pose2.hpp"

/// Compounding by the unscented transform (Julier 1999; Wang 2004, section 2.1) in place of the
/// linear one: keeps the second-order terms that a large heading error has. The baseline that tests
/// hold the linear one against, and no part of the product: where that chains the least sure
/// headings, all ties between the submaps of a building with their sigmas doubled (0.22 rad in the
/// end), the two differ by 3 % in sigma and 0.07 sigma in the mean; in a city by less than 0.1 %.
namespace slammot::geometry::unscented {

/// Chains two uncertain poses. cross: covariance of the first with the second, rows of the first.
UncertainPose2 compound(const UncertainPose2& a_from_b, const UncertainPose2& b_from_c,
                        const Matrix3& cross = Matrix3::Zero());

/// b_from_a with its covariance.
UncertainPose2 inverse(const UncertainPose2& a_from_b);

/// b_from_c from two poses that share the frame a.
UncertainPose2 tail_to_tail(const UncertainPose2& a_from_b, const UncertainPose2& a_from_c,
                            const Matrix3& cross = Matrix3::Zero());

}  // namespace slammot::geometry::unscented
