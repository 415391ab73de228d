#include "common/sensing/variance_factor.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::sensing {
namespace {

using geometry::Matrix3;

/// Turns (x, y, heading) of the pose's frame into (forward, left, heading) of the vehicle.
Matrix3 vehicle_axes(double heading_rad) {
  Matrix3 turn = Matrix3::Identity();
  turn.topLeftCorner<2, 2>() = geometry::rotation(-heading_rad);
  return turn;
}

}  // namespace

VarianceFactors learned(const VarianceFactors& factors, const geometry::UncertainPose2& predicted,
                        const geometry::UncertainPose2& matched, double share) {
  constexpr double kLargestSurprise = 25.0;  // one wrong match must not drown the rest
  const Matrix3 turn = vehicle_axes(predicted.pose.heading_rad);
  const Eigen::Vector3d change = turn * geometry::difference(matched.pose, predicted.pose);
  // Prediction and match are correlated: the variance of their difference is the difference of their variances.
  const Eigen::Vector3d expected = (turn * (predicted.covariance - matched.covariance) * turn.transpose()).diagonal();
  const Eigen::Vector3d known = (turn * predicted.covariance * turn.transpose()).diagonal();
  VarianceFactors next = factors;
  for (int axis = 0; axis < 3; ++axis) {
    constexpr double kSaidNothing = 1e-3;
    if (!(expected[axis] > kSaidNothing * known[axis])) continue;
    const double squared = std::min(change[axis] * change[axis] / expected[axis], kLargestSurprise * factors.of_axis[axis]);
    next.of_axis[axis] += share * (squared - factors.of_axis[axis]);
  }
  return next;
}

Matrix3 scaled(const geometry::UncertainPose2& pose, const VarianceFactors& factors) {
  const Matrix3 turn = vehicle_axes(pose.pose.heading_rad);
  const Matrix3 stretch = turn.transpose() * factors.of_axis.cwiseSqrt().asDiagonal() * turn;
  return stretch * pose.covariance * stretch.transpose();
}

}  // namespace slammot::sensing
