#include "common/graphs/submap_filter.hpp"

#include <algorithm>
#include <cassert>

#include <Eigen/Cholesky>

#include "common/geometry/twist.hpp"

namespace slammot::graphs {
namespace {

using geometry::Matrix3;
using geometry::Pose2;
using geometry::UncertainPose2;

Eigen::Index first_of(std::size_t node) { return 3 * static_cast<Eigen::Index>(node); }

/// Covariance of a measured relative pose as a twist of the map in which `from` lies.
Matrix3 noise_in_map(const Pose2& map_from_from, const UncertainPose2& from_to) {
  const Matrix3 by_measurement =
      geometry::adjoint(map_from_from) * geometry::twist_by_change(from_to.pose);
  return by_measurement * from_to.covariance * by_measurement.transpose();
}

}  // namespace

/// Twist from the predicted to the measured pose of `to`, and its covariance.
struct SubmapFilter::Innovation {
  Eigen::Vector3d twist;
  Matrix3 S;
};

Matrix3 SubmapFilter::twist_covariance(std::size_t a, std::size_t b) const {
  const auto block = covariance_.block<3, 3>(first_of(std::max(a, b)), first_of(std::min(a, b)));
  if (a == b) return block.selfadjointView<Eigen::Lower>();
  return a > b ? Matrix3(block) : Matrix3(block.transpose());
}

Matrix3 SubmapFilter::covariance(std::size_t a, std::size_t b) const {
  return geometry::change_by_twist(pose(a)) * twist_covariance(a, b) *
         geometry::change_by_twist(pose(b)).transpose();
}

SubmapFilter::Columns SubmapFilter::columns(std::size_t node) const {
  const Eigen::Index first = first_of(node);
  const Eigen::Index below = covariance_.rows() - first - 3;
  Columns columns(covariance_.rows(), 3);
  columns.topRows(first) = covariance_.block(first, 0, 3, first).transpose();
  columns.middleRows<3>(first) = twist_covariance(node, node);
  columns.bottomRows(below) = covariance_.block(first + 3, first, below, 3);
  return columns;
}

std::size_t SubmapFilter::append(const Pose2& pose) {
  map_from_node_.push_back(pose);
  const Eigen::Index size = covariance_.rows() + 3;
  covariance_.conservativeResize(size, size);
  covariance_.bottomRows<3>().setZero();
  return this->size() - 1;
}

std::size_t SubmapFilter::add_known(const Pose2& map_from_node) { return append(map_from_node); }

std::size_t SubmapFilter::predict(std::size_t from, const UncertainPose2& from_to) {
  assert(from < size());
  const Pose2 map_from_from = pose(from);
  const Matrix3 covariance_of_from = twist_covariance(from, from);
  const Columns with_from = columns(from);
  const std::size_t to = append(map_from_from * from_to.pose);
  covariance_.block(first_of(to), 0, 3, first_of(to)) = with_from.transpose();
  covariance_.block<3, 3>(first_of(to), first_of(to)) =
      covariance_of_from + noise_in_map(map_from_from, from_to);
  return to;
}

SubmapFilter::Innovation SubmapFilter::innovation(std::size_t from, std::size_t to,
                                                  const UncertainPose2& from_to) const {
  const Matrix3 cross = twist_covariance(from, to);
  return {geometry::logarithm(pose(from) * from_to.pose * geometry::inverse(pose(to))),
          twist_covariance(from, from) + twist_covariance(to, to) - cross - cross.transpose() +
              noise_in_map(pose(from), from_to)};
}

double SubmapFilter::squared_innovation(std::size_t from, std::size_t to,
                                        const UncertainPose2& from_to) const {
  const auto [twist, S] = innovation(from, to, from_to);
  return twist.dot(S.ldlt().solve(twist));
}

void SubmapFilter::update(std::size_t from, std::size_t to, const UncertainPose2& from_to) {
  const auto [twist, S] = innovation(from, to, from_to);
  // The measurement is the twist of `to` less that of `from`.
  const Columns P_Ht = columns(to) - columns(from);
  const Columns K = S.ldlt().solve(P_Ht.transpose()).transpose();
  // Joseph: (I - K H) P (I - K H)^T + K R K^T = P - K M^T - M K^T with this M.
  const Columns M = P_Ht - 0.5 * K * S;
  covariance_.triangularView<Eigen::Lower>() -= K * M.transpose();
  covariance_.triangularView<Eigen::Lower>() -= M * K.transpose();
  for (std::size_t node = 0; node < size(); ++node) {
    map_from_node_[node] =
        geometry::exponential(K.middleRows<3>(first_of(node)) * twist) * map_from_node_[node];
  }
}

}  // namespace slammot::graphs
