#pragma once

#include <Eigen/Core>

namespace slammot::geometry {

using Vector2 = Eigen::Vector2d;
using Matrix2 = Eigen::Matrix2d;
using Matrix3 = Eigen::Matrix3d;

/// Angle wrapped to (-pi, pi].
double wrap_angle(double angle_rad);

/// Rigid motion in the plane. A variable is named target_from_source and maps points of source to
/// target.
struct Pose2 {
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;  ///< In (-pi, pi] when made by the functions here.

  static Pose2 identity() { return {}; }
  Vector2 translation_m() const { return {x_m, y_m}; }
};

bool operator==(const Pose2& a, const Pose2& b);

/// Composition a_from_c = a_from_b ∘ b_from_c; Wang 2004, Eq. (2.2).
Pose2 operator*(const Pose2& a_from_b, const Pose2& b_from_c);

/// Point of b expressed in a.
Vector2 operator*(const Pose2& a_from_b, const Vector2& point_in_b);

/// b_from_a; Wang 2004, Eq. (2.6).
Pose2 inverse(const Pose2& a_from_b);

/// 2x2 rotation by angle_rad, counter-clockwise.
Matrix2 rotation(double angle_rad);

/// Difference a - b: (x [m], y [m], heading [rad], wrapped), in the axes of the common frame.
Eigen::Vector3d difference(const Pose2& a, const Pose2& b);

/// Third component of the cross product of two vectors in the plane.
inline double cross(const Vector2& a, const Vector2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Linear interpolation of x, y and heading (the short way round). fraction 0 gives from, 1 gives
/// to; other values extrapolate.
Pose2 interpolate(const Pose2& from, const Pose2& to, double fraction);

}  // namespace slammot::geometry
