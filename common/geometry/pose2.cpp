#include "common/geometry/pose2.hpp"

#include <cmath>
#include <numbers>

namespace slammot::geometry {

double wrap_angle(double angle_rad) {
  if (angle_rad > -std::numbers::pi && angle_rad <= std::numbers::pi)
    return angle_rad;  // the usual case; a remainder costs 10 ns
  const double wrapped = std::remainder(angle_rad, 2.0 * std::numbers::pi);
  return wrapped <= -std::numbers::pi ? std::numbers::pi : wrapped;
}

bool operator==(const Pose2& a, const Pose2& b) {
  return a.x_m == b.x_m && a.y_m == b.y_m && a.heading_rad == b.heading_rad;
}

Pose2 operator*(const Pose2& a_from_b, const Pose2& b_from_c) {
  const double c = std::cos(a_from_b.heading_rad);
  const double s = std::sin(a_from_b.heading_rad);
  return {a_from_b.x_m + c * b_from_c.x_m - s * b_from_c.y_m,
          a_from_b.y_m + s * b_from_c.x_m + c * b_from_c.y_m,
          wrap_angle(a_from_b.heading_rad + b_from_c.heading_rad)};
}

Vector2 operator*(const Pose2& a_from_b, const Vector2& point_in_b) {
  const double c = std::cos(a_from_b.heading_rad);
  const double s = std::sin(a_from_b.heading_rad);
  return {a_from_b.x_m + c * point_in_b.x() - s * point_in_b.y(),
          a_from_b.y_m + s * point_in_b.x() + c * point_in_b.y()};
}

Pose2 inverse(const Pose2& a_from_b) {
  const double c = std::cos(a_from_b.heading_rad);
  const double s = std::sin(a_from_b.heading_rad);
  return {-c * a_from_b.x_m - s * a_from_b.y_m, s * a_from_b.x_m - c * a_from_b.y_m,
          wrap_angle(-a_from_b.heading_rad)};
}

Matrix2 rotation(double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return Matrix2{{c, -s}, {s, c}};
}

Eigen::Vector3d difference(const Pose2& a, const Pose2& b) {
  return {a.x_m - b.x_m, a.y_m - b.y_m, wrap_angle(a.heading_rad - b.heading_rad)};
}

Pose2 interpolate(const Pose2& from, const Pose2& to, double fraction) {
  return {from.x_m + fraction * (to.x_m - from.x_m), from.y_m + fraction * (to.y_m - from.y_m),
          wrap_angle(from.heading_rad + fraction * wrap_angle(to.heading_rad - from.heading_rad))};
}

}  // namespace slammot::geometry
