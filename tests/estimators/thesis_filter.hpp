#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "common/geometry/displacement.hpp"
#include "common/geometry/uncertain_pose2.hpp"
#include "common/graphs/relative_pose.hpp"

namespace slammot::estimators {

/// Kalman filter over submaps as the thesis has it: errors are (x [m], y [m], heading [rad]), with
/// Jacobians at the present estimate (Wang 2004, Eqs. (2.1)-(2.10)). To compare with
/// graphs::SubmapFilter.
class ThesisFilter {
 public:
  std::size_t add_known(const geometry::Pose2& pose) {
    const Eigen::Index size = mean_.size() + 3;
    mean_.conservativeResize(size);
    mean_.tail<3>() << pose.x_m, pose.y_m, pose.heading_rad;
    covariance_.conservativeResize(size, size);
    covariance_.rightCols<3>().setZero();
    covariance_.bottomRows<3>().setZero();
    return static_cast<std::size_t>(size) / 3 - 1;
  }

  std::size_t predict(std::size_t from, const geometry::UncertainPose2& from_to) {
    const geometry::Pose2 at = pose(from);
    const geometry::Matrix3 by_from = geometry::compound_jacobian_first(at, from_to.pose);
    const geometry::Matrix3 by_step = geometry::compound_jacobian_second(at);
    const std::size_t to = add_known(at * from_to.pose);
    const Eigen::Index before = row(to);
    covariance_.block(before, 0, 3, before) =
        by_from * covariance_.block(row(from), 0, 3, before).eval();
    covariance_.block(0, before, before, 3) =
        covariance_.block(before, 0, 3, before).transpose().eval();
    covariance_.block<3, 3>(before, before) = by_from * covariance(from) * by_from.transpose() +
                                              by_step * from_to.covariance * by_step.transpose();
    return to;
  }

  void update(std::size_t from, std::size_t to, const geometry::UncertainPose2& from_to) {
    const graphs::RelativePose expected = graphs::relative_pose(pose(from), pose(to));
    const Eigen::MatrixXd P_Ht =
        covariance_.middleCols<3>(row(from)) * expected.by_from.transpose() +
        covariance_.middleCols<3>(row(to)) * expected.by_to.transpose();
    const geometry::Matrix3 S = expected.by_from * P_Ht.middleRows<3>(row(from)) +
                                expected.by_to * P_Ht.middleRows<3>(row(to)) + from_to.covariance;
    const Eigen::MatrixXd K = S.ldlt().solve(P_Ht.transpose()).transpose();
    mean_ += K * geometry::difference(from_to.pose, expected.from_to);
    covariance_ -= K * S * K.transpose();
  }

  std::size_t size() const { return static_cast<std::size_t>(mean_.size()) / 3; }
  geometry::Pose2 pose(std::size_t node) const {
    return geometry::displaced({}, mean_.segment<3>(row(node)));
  }
  geometry::Matrix3 covariance(std::size_t node) const {
    return covariance_.block<3, 3>(row(node), row(node));
  }

 private:
  static Eigen::Index row(std::size_t node) { return 3 * static_cast<Eigen::Index>(node); }

  Eigen::VectorXd mean_;
  Eigen::MatrixXd covariance_;
};

}  // namespace slammot::estimators
