#include "common/geometry/uncertain_pose2.hpp"

#include <cmath>

namespace slammot::geometry {

Matrix3 compound_jacobian_first(const Pose2& a_from_b, const Pose2& b_from_c) {
  return compound_jacobian_first(rotation(a_from_b.heading_rad) * b_from_c.translation_m());
}

Matrix3 compound_jacobian_first(const Vector2& lever_in_a) {
  Matrix3 jacobian = Matrix3::Identity();
  jacobian(0, 2) = -lever_in_a.y();
  jacobian(1, 2) = lever_in_a.x();
  return jacobian;
}

Matrix3 compound_jacobian_second(const Pose2& a_from_b) {
  Matrix3 jacobian = Matrix3::Identity();
  jacobian.topLeftCorner<2, 2>() = rotation(a_from_b.heading_rad);
  return jacobian;
}

Matrix3 inverse_jacobian(const Pose2& a_from_b) {
  const Pose2 b_from_a = inverse(a_from_b);
  const double c = std::cos(a_from_b.heading_rad);
  const double s = std::sin(a_from_b.heading_rad);
  return Matrix3{{-c, -s, b_from_a.y_m}, {s, -c, -b_from_a.x_m}, {0.0, 0.0, -1.0}};
}

UncertainPose2 compound(const UncertainPose2& a_from_b, const UncertainPose2& b_from_c,
                        const Matrix3& cross) {
  const Matrix3 J1 = compound_jacobian_first(a_from_b.pose, b_from_c.pose);
  const Matrix3 J2 = compound_jacobian_second(a_from_b.pose);
  const Matrix3 mixed = J1 * cross * J2.transpose();
  return {a_from_b.pose * b_from_c.pose, J1 * a_from_b.covariance * J1.transpose() +
                                             J2 * b_from_c.covariance * J2.transpose() + mixed +
                                             mixed.transpose()};
}

UncertainPose2 inverse(const UncertainPose2& a_from_b) {
  const Matrix3 J = inverse_jacobian(a_from_b.pose);
  return {inverse(a_from_b.pose), J * a_from_b.covariance * J.transpose()};
}

UncertainPose2 tail_to_tail(const UncertainPose2& a_from_b, const UncertainPose2& a_from_c,
                            const Matrix3& cross) {
  return compound(inverse(a_from_b), a_from_c, inverse_jacobian(a_from_b.pose) * cross);
}

}  // namespace slammot::geometry
