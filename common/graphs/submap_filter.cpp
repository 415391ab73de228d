#include "common/graphs/submap_filter.hpp"

#include <cassert>

#include <Eigen/Cholesky>

#include "common/graphs/relative_pose.hpp"

namespace slammot::graphs {
namespace {

using geometry::Matrix3;
using geometry::Pose2;
using geometry::UncertainPose2;

using Gain = Eigen::Matrix<double, Eigen::Dynamic, 3>;

Eigen::Index first_of(std::size_t node) { return 3 * static_cast<Eigen::Index>(node); }

Pose2 displaced(const Pose2& pose, const Eigen::Vector3d& change) {
  return {pose.x_m + change.x(), pose.y_m + change.y(),
          geometry::wrap_angle(pose.heading_rad + change.z())};
}

}  // namespace

Pose2 SubmapFilter::pose(std::size_t node) const {
  const Eigen::Vector3d mean = mean_.segment<3>(first_of(node));
  return {mean.x(), mean.y(), mean.z()};
}

Matrix3 SubmapFilter::covariance(std::size_t a, std::size_t b) const {
  return covariance_.block<3, 3>(first_of(a), first_of(b));
}

std::size_t SubmapFilter::append(const Pose2& pose) {
  const Eigen::Index size = mean_.size() + 3;
  mean_.conservativeResize(size);
  mean_.tail<3>() << pose.x_m, pose.y_m, pose.heading_rad;
  covariance_.conservativeResize(size, size);
  covariance_.rightCols<3>().setZero();
  covariance_.bottomRows<3>().setZero();
  return this->size() - 1;
}

std::size_t SubmapFilter::add_known(const Pose2& map_from_node) { return append(map_from_node); }

std::size_t SubmapFilter::predict(std::size_t from, const UncertainPose2& from_to) {
  assert(from < size());
  const Pose2 map_from_from = pose(from);
  const Matrix3 by_from = geometry::compound_jacobian_first(map_from_from, from_to.pose);
  const Matrix3 by_step = geometry::compound_jacobian_second(map_from_from);
  const Matrix3 covariance_of_from = covariance(from, from);
  const std::size_t to = append(map_from_from * from_to.pose);
  const Eigen::Index before = first_of(to);
  const Eigen::Matrix<double, 3, Eigen::Dynamic> cross =
      by_from * covariance_.block(first_of(from), 0, 3, before);
  covariance_.block(before, 0, 3, before) = cross;
  covariance_.block(0, before, before, 3) = cross.transpose();
  covariance_.block<3, 3>(before, before) = by_from * covariance_of_from * by_from.transpose() +
                                            by_step * from_to.covariance * by_step.transpose();
  return to;
}

double SubmapFilter::squared_innovation(std::size_t from, std::size_t to,
                                        const UncertainPose2& from_to) const {
  const RelativePose expected = relative_pose(pose(from), pose(to));
  const Matrix3 cross = expected.by_from * covariance(from, to) * expected.by_to.transpose();
  const Matrix3 S = expected.by_from * covariance(from, from) * expected.by_from.transpose() +
                    expected.by_to * covariance(to, to) * expected.by_to.transpose() + cross +
                    cross.transpose() + from_to.covariance;
  const Eigen::Vector3d innovation = geometry::difference(from_to.pose, expected.from_to);
  return innovation.dot(S.ldlt().solve(innovation));
}

void SubmapFilter::update(std::size_t from, std::size_t to, const UncertainPose2& from_to) {
  constexpr int kLinearizations = 3;
  const Pose2 predicted_from = pose(from);
  const Pose2 predicted_to = pose(to);
  Pose2 at_from = predicted_from;
  Pose2 at_to = predicted_to;
  Gain K;
  Matrix3 S;
  Eigen::Vector3d innovation;
  for (int i = 0; i < kLinearizations; ++i) {
    const auto [expected, by_from, by_to] = relative_pose(at_from, at_to);
    const Gain P_Ht = covariance_.middleCols<3>(first_of(from)) * by_from.transpose() +
                      covariance_.middleCols<3>(first_of(to)) * by_to.transpose();
    S = by_from * P_Ht.middleRows<3>(first_of(from)) + by_to * P_Ht.middleRows<3>(first_of(to)) +
        from_to.covariance;
    K = S.ldlt().solve(P_Ht.transpose()).transpose();
    innovation = geometry::difference(from_to.pose, expected) -
                 by_from * geometry::difference(predicted_from, at_from) -
                 by_to * geometry::difference(predicted_to, at_to);
    at_from = displaced(predicted_from, K.middleRows<3>(first_of(from)) * innovation);
    at_to = displaced(predicted_to, K.middleRows<3>(first_of(to)) * innovation);
  }
  mean_ += K * innovation;
  for (Eigen::Index heading = 2; heading < mean_.size(); heading += 3)
    mean_[heading] = geometry::wrap_angle(mean_[heading]);
  const Gain K_S = K * S;
  covariance_.noalias() -= K_S * K.transpose();
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();
}

}  // namespace slammot::graphs
