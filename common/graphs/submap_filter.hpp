#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/uncertain_pose2.hpp"

namespace slammot::graphs {

/// Extended Kalman filter over submaps as features with three degrees of freedom: Wang 2004,
/// sections 2.2 and 3.5. State: poses of all submaps in one frame with their joint covariance. A
/// submap is added by compounding (prediction) and corrected by a measured relative pose, tail to
/// tail (update). Submaps are numbered in the order in which they were added.
///
/// Errors are twists (common/geometry/twist.hpp) in place of (x, y, heading). Then no derivative by
/// the state depends on headings that later updates change, and the filter stays consistent where
/// headings are uncertain (Barrau and Bonnabel 2015; docs/decisions/loop-closing.md).
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

  /// Corrects all submaps by a measured relative pose: Wang 2004, Eqs. (2.8)-(2.10). Covariance in
  /// Joseph's form: an error of the gain enters it squared.
  void update(std::size_t from, std::size_t to, const geometry::UncertainPose2& from_to);

  std::size_t size() const { return map_from_node_.size(); }
  const geometry::Pose2& pose(std::size_t node) const { return map_from_node_[node]; }

  /// Covariance of two poses (x [m], y [m], heading [rad]); of one with itself where both are
  /// equal.
  geometry::Matrix3 covariance(std::size_t a, std::size_t b) const;

 private:
  using Columns = Eigen::Matrix<double, Eigen::Dynamic, 3>;
  struct Innovation;

  std::size_t append(const geometry::Pose2& pose);
  geometry::Matrix3 twist_covariance(std::size_t a, std::size_t b) const;
  Columns columns(std::size_t node) const;
  Innovation innovation(std::size_t from, std::size_t to,
                        const geometry::UncertainPose2& from_to) const;

  std::vector<geometry::Pose2> map_from_node_;
  Eigen::MatrixXd covariance_;  ///< Of all twists; only the lower triangle is kept.
};

}  // namespace slammot::graphs
