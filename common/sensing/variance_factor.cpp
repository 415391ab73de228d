#include "common/sensing/variance_factor.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::sensing {
namespace {

using geometry::Matrix3;

/// Rotation from the pose's frame (x, y, heading) to vehicle axes (forward, left, heading).
Matrix3 vehicle_axes(double heading_rad) {
  Matrix3 turn = Matrix3::Identity();
  turn.topLeftCorner<2, 2>() = geometry::rotation(-heading_rad);
  return turn;
}

constexpr double kSaidNothing = 1e-3;  // least share of an axis' variance that an informative match
                                       // removes

Eigen::Vector3d along_axes(const Matrix3& covariance, double heading_rad) {
  const Matrix3 turn = vehicle_axes(heading_rad);
  return (turn * covariance * turn.transpose()).diagonal();
}

}  // namespace

VarianceFactors learned(const VarianceFactors& factors, const geometry::UncertainPose2& predicted,
                        const geometry::UncertainPose2& matched, double share) {
  constexpr double kLargestSurprise = 25.0;  // limits the effect of one wrong match
  const Matrix3 turn = vehicle_axes(predicted.pose.heading_rad);
  const Eigen::Vector3d change = turn * geometry::difference(matched.pose, predicted.pose);
  // Prediction and match are correlated: the variance of their difference is the difference of
  // their variances.
  const Eigen::Vector3d expected =
      along_axes(predicted.covariance - matched.covariance, predicted.pose.heading_rad);
  const Eigen::Vector3d known = along_axes(predicted.covariance, predicted.pose.heading_rad);
  VarianceFactors next = factors;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(expected[axis] > kSaidNothing * known[axis])) continue;
    const double squared = std::min(change[axis] * change[axis] / expected[axis],
                                    kLargestSurprise * factors.of_axis[axis]);
    next.of_axis[axis] += share * (squared - factors.of_axis[axis]);
  }
  return next;
}

VarianceFactors carried(const VarianceFactors& factors, const geometry::UncertainPose2& before,
                        const geometry::UncertainPose2& predicted,
                        const geometry::UncertainPose2& matched) {
  const Eigen::Vector3d was = along_axes(before.covariance, before.pose.heading_rad);
  const Eigen::Vector3d known = along_axes(predicted.covariance, predicted.pose.heading_rad);
  const Eigen::Vector3d told =
      along_axes(predicted.covariance - matched.covariance, predicted.pose.heading_rad);
  const auto is_observed = [&](int axis) { return told[axis] > kSaidNothing * known[axis]; };
  const bool is_reckoned[] = {!is_observed(0), !is_observed(1) && is_observed(2)};
  VarianceFactors next = factors;
  for (int axis = 0; axis < 2; ++axis) {
    if (!(known[axis] > 0.0)) continue;
    const double grown = is_reckoned[axis] ? std::max(0.0, known[axis] - was[axis]) : 0.0;
    next.dead_reckoned[axis] =
        std::min(1.0, (factors.dead_reckoned[axis] * std::min(was[axis], known[axis]) + grown) /
                          known[axis]);
  }
  return next;
}

VarianceFactors published(const VarianceFactors& factors, const PoseErrors& errors,
                          const MapChange& change) {
  const AxisError* const of_axis[] = {&errors.forward, &errors.sideways, &errors.heading};
  VarianceFactors next;
  for (int axis = 0; axis < 3; ++axis) {
    const AxisError& error = *of_axis[axis];
    const double renewed = change.way_m / (change.way_m + error.view_m);
    const double of_map =
        error.of_surprises * factors.of_axis[axis] + error.of_map * change.squared_residuals;
    const double matched = error.of_scan * change.squared_residuals + renewed * of_map;
    next.of_axis[axis] = matched + factors.dead_reckoned[axis] * (1.0 - matched);
  }
  return next;
}

Matrix3 scaled(const geometry::UncertainPose2& pose, const VarianceFactors& factors) {
  const Matrix3 turn = vehicle_axes(pose.pose.heading_rad);
  const Matrix3 stretch = turn.transpose() * factors.of_axis.cwiseSqrt().asDiagonal() * turn;
  return stretch * pose.covariance * stretch.transpose();
}

}  // namespace slammot::sensing
