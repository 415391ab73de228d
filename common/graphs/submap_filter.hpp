#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "common/geometry/uncertain_pose2.hpp"

namespace slammot::graphs {

/// Extended Kalman filter over submaps as features with three degrees of freedom: Wang 2004,
/// sections 2.2 and 3.5. State: poses of all submaps in one frame, ordered (x [m], y [m], heading
/// [rad]) each, with their joint covariance. A submap is added by compounding (prediction) and
/// corrected by a measured relative pose (update). Submaps are numbered in the order in which they
/// were added.
class SubmapFilter {
 public:
  /// Adds a submap at a known pose, without error: the first one defines the frame.
  std::size_t add_known(const geometry::Pose2& map_from_node);

  /// Adds a submap by its measured pose relative to a known one: Wang 2004, Eqs. (2.1)-(2.4).
  std::size_t predict(std::size_t from, const geometry::UncertainPose2& from_to);

  /// Squared Mahalanobis distance of a measured relative pose from the state, with the covariances
  /// of both: chi-square, 3 degrees of freedom.
  double squared_innovation(std::size_t from, std::size_t to,
                            const geometry::UncertainPose2& from_to) const;

  /// Corrects all submaps by a measured relative pose. The measurement is linearized again at the
  /// corrected pose a few times (iterated Kalman filter), since a loop is often closed from metres
  /// off.
  void update(std::size_t from, std::size_t to, const geometry::UncertainPose2& from_to);

  std::size_t size() const { return static_cast<std::size_t>(mean_.size()) / 3; }
  geometry::Pose2 pose(std::size_t node) const;

  /// Covariance of two poses; of one with itself where both are equal.
  geometry::Matrix3 covariance(std::size_t a, std::size_t b) const;

 private:
  std::size_t append(const geometry::Pose2& pose);

  Eigen::VectorXd mean_;
  Eigen::MatrixXd covariance_;
};

}  // namespace slammot::graphs
