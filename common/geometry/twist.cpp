#include "common/geometry/twist.hpp"

#include <cmath>

namespace slammot::geometry {
namespace {

constexpr double kSmallAngle_rad = 1e-8;  ///< Below it, the first order is exact.

}  // namespace

Pose2 exponential(const Eigen::Vector3d& twist) {
  const double half = 0.5 * twist.z();
  const bool is_small = std::abs(half) < kSmallAngle_rad;
  const double along = is_small ? 1.0 : std::sin(half) * std::cos(half) / half;
  const double across = is_small ? half : std::sin(half) * std::sin(half) / half;
  return {along * twist.x() - across * twist.y(), across * twist.x() + along * twist.y(),
          wrap_angle(twist.z())};
}

Eigen::Vector3d logarithm(const Pose2& motion) {
  const double half = 0.5 * motion.heading_rad;
  const double along = std::abs(half) < kSmallAngle_rad ? 1.0 : half / std::tan(half);
  return {along * motion.x_m + half * motion.y_m, along * motion.y_m - half * motion.x_m,
          motion.heading_rad};
}

Matrix3 adjoint(const Pose2& a_from_b) {
  Matrix3 adjoint = twist_by_change(a_from_b);
  adjoint.topLeftCorner<2, 2>() = rotation(a_from_b.heading_rad);
  return adjoint;
}

Matrix3 twist_by_change(const Pose2& pose) {
  Matrix3 jacobian = Matrix3::Identity();
  jacobian.topRightCorner<2, 1>() << pose.y_m, -pose.x_m;
  return jacobian;
}

Matrix3 change_by_twist(const Pose2& pose) {
  return twist_by_change({-pose.x_m, -pose.y_m, pose.heading_rad});
}

}  // namespace slammot::geometry
