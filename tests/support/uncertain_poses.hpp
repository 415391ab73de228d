#pragma once

#include <functional>
#include <random>

#include <Eigen/Cholesky>

#include "common/geometry/displacement.hpp"
#include "common/geometry/uncertain_pose2.hpp"

namespace slammot::testing {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Two poses whose errors belong together.
struct CorrelatedPoses {
  geometry::UncertainPose2 first;
  geometry::UncertainPose2 second;
  geometry::Matrix3 cross = geometry::Matrix3::Zero();  ///< Rows of the first, columns of the
                                                        ///< second.
};

/// Positive definite, every entry in use; sigma_rad: of both headings.
inline CorrelatedPoses correlated_poses(const geometry::Pose2& first, const geometry::Pose2& second,
                                        double sigma_m, double sigma_rad) {
  std::mt19937_64 random(13);
  std::normal_distribution<double> normal;
  Matrix6 root = Matrix6::NullaryExpr([&] { return 0.4 * normal(random); });
  root.diagonal().array() += 1.0;
  Matrix6 joint = root * root.transpose();
  const Eigen::Matrix<double, 6, 1> sigmas{sigma_m, sigma_m, sigma_rad,
                                           sigma_m, sigma_m, sigma_rad};
  const Matrix6 scale = (sigmas.array() / joint.diagonal().array().sqrt()).matrix().asDiagonal();
  joint = scale * joint * scale;
  return {{first, joint.topLeftCorner<3, 3>()},
          {second, joint.bottomRightCorner<3, 3>()},
          joint.topRightCorner<3, 3>()};
}

using OfTwoPoses = std::function<geometry::Pose2(const geometry::Pose2&, const geometry::Pose2&)>;

/// Mean and covariance of many draws; what a formula is held against. Headings are averaged about
/// that of the means.
inline geometry::UncertainPose2 by_monte_carlo(const CorrelatedPoses& poses,
                                               const OfTwoPoses& operation, int draws,
                                               std::uint64_t seed) {
  Matrix6 joint;
  joint << poses.first.covariance, poses.cross, poses.cross.transpose(), poses.second.covariance;
  const Matrix6 root = joint.llt().matrixL();
  const geometry::Pose2 middle = operation(poses.first.pose, poses.second.pose);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  geometry::Matrix3 squares = geometry::Matrix3::Zero();
  for (int i = 0; i < draws; ++i) {
    const Eigen::Matrix<double, 6, 1> error =
        root * Eigen::Matrix<double, 6, 1>::NullaryExpr([&] { return normal(random); });
    const geometry::Pose2 drawn =
        operation(geometry::displaced(poses.first.pose, error.head<3>()),
                  geometry::displaced(poses.second.pose, error.tail<3>()));
    const Eigen::Vector3d away = geometry::difference(drawn, middle);
    sum += away / draws;
    squares += away * away.transpose() / draws;
  }
  return {geometry::displaced(middle, sum), squares - sum * sum.transpose()};
}

}  // namespace slammot::testing
