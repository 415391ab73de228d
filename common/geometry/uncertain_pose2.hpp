#pragma once

#include "common/geometry/pose2.hpp"

namespace slammot::geometry {

/// Gaussian over a pose. The covariance is 3x3 over (x [m], y [m], heading [rad]) in the frame
/// named first.
struct UncertainPose2 {
  Pose2 pose;
  Matrix3 covariance = Matrix3::Zero();
};

/// Jacobian of (a_from_b ∘ b_from_c) with respect to a_from_b; Wang 2004, Eq. (2.4).
Matrix3 compound_jacobian_first(const Pose2& a_from_b, const Pose2& b_from_c);

/// The same Jacobian from the lever alone: the translation of b_from_c, rotated into a.
Matrix3 compound_jacobian_first(const Vector2& lever_in_a);

/// Jacobian of (a_from_b ∘ b_from_c) with respect to b_from_c; Wang 2004, Eq. (2.5).
Matrix3 compound_jacobian_second(const Pose2& a_from_b);

/// Jacobian of the inverse; Wang 2004, Eq. (2.7).
Matrix3 inverse_jacobian(const Pose2& a_from_b);

/// Compounds two uncertain poses, to first order; Wang 2004, Eqs. (2.1)-(2.4). cross: covariance of
/// the first with the second, rows of the first; zero if independent, Eq. (2.5).
UncertainPose2 compound(const UncertainPose2& a_from_b, const UncertainPose2& b_from_c,
                        const Matrix3& cross = Matrix3::Zero());

/// b_from_a with its covariance, to first order; Wang 2004, Eqs. (2.6)-(2.7).
UncertainPose2 inverse(const UncertainPose2& a_from_b);

/// b_from_c from two poses that share the frame a (tail-to-tail), to first order; Wang 2004, Eqs.
/// (2.8)-(2.10), whose (2.10) has the indices jk for ik. cross: covariance of the first with the
/// second, rows of the first.
UncertainPose2 tail_to_tail(const UncertainPose2& a_from_b, const UncertainPose2& a_from_c,
                            const Matrix3& cross = Matrix3::Zero());

}  // namespace slammot::geometry
