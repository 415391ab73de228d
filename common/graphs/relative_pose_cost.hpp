#pragma once

#include <cmath>

#include <ceres/ceres.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "common/geometry/pose2.hpp"
#include "common/graphs/relative_pose.hpp"

namespace slammot::graphs {

/// Upper triangular square root W of the information: W' W = covariance^-1.
inline geometry::Matrix3 whitening_of(const geometry::Matrix3& covariance) {
  return geometry::Matrix3(covariance.inverse()).llt().matrixU();
}

/// Whitened error of a relative pose in the frame of `from`; blocks are (x [m], y [m], heading
/// [rad]) in map.
class RelativePoseCost final : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  /// weight: factor on the squared error; read at each evaluation.
  RelativePoseCost(const geometry::Pose2& measured_from_to, const geometry::Matrix3& whitening,
                   const double& weight)
      : measured_(measured_from_to), unweighted_(whitening), weight_(weight) {}

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const geometry::Pose2 map_from_from{blocks[0][0], blocks[0][1], blocks[0][2]};
    const geometry::Pose2 map_from_to{blocks[1][0], blocks[1][1], blocks[1][2]};
    const RelativePose relative = relative_pose(map_from_from, map_from_to);
    const geometry::Matrix3 whitening = std::sqrt(weight_) * unweighted_;
    Eigen::Map<Eigen::Vector3d>{residuals} =
        whitening * geometry::difference(relative.from_to, measured_);
    if (jacobians == nullptr) return true;
    using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    if (jacobians[0] != nullptr) Eigen::Map<RowMajor>{jacobians[0]} = whitening * relative.by_from;
    if (jacobians[1] != nullptr) Eigen::Map<RowMajor>{jacobians[1]} = whitening * relative.by_to;
    return true;
  }

 private:
  geometry::Pose2 measured_;
  geometry::Matrix3 unweighted_;
  const double& weight_;
};

}  // namespace slammot::graphs
