#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "examples/joint_posterior/generic_object.hpp"
#include "examples/joint_posterior/world.hpp"

namespace slammot::joint_posterior {

/// State in the filter: a landmark is (x, y), a generic object (x, y, vx, vy) with its modes.
enum class ObjectKind : std::uint8_t { kLandmark, kGeneric };

/// One extended Kalman filter over the vehicle's pose and any objects: SLAM with generic objects
/// (Wang 2004, Eq. 2.55), or with landmarks alone the SLAM of Section 2.5. The modes of each
/// generic object are merged at its measurement (GPB1), in the joint covariance.
class JointFilter {
 public:
  /// The pose is known at the start: it defines world.
  JointFilter();

  /// Index of a new object, placed by its first observation.
  std::size_t add(ObjectKind kind, const Eigen::Vector2d& range_bearing);

  /// Predicts the pose over one period. Each generic object follows at its observation, in each of
  /// its modes: observations of the others do not depend on its motion. One that is not observed is
  /// predicted with merged modes before the next period.
  void predict(const Control& control);

  void update(std::size_t object, const Eigen::Vector2d& range_bearing);

  geometry::Pose2 world_from_base() const { return {mean_[0], mean_[1], mean_[2]}; }
  Eigen::Matrix3d pose_covariance() const { return P_.topLeftCorner<3, 3>(); }
  Eigen::Index size() const { return mean_.size(); }

  /// Place and, of a generic object, velocity; a landmark has none.
  ObjectEstimate estimate(std::size_t object) const;

 private:
  struct Object {
    ObjectKind kind;
    Eigen::Index at;  ///< Of its first number in the state.
    ModeWeights weights = kUnknownMode;
    bool is_due = false;  ///< Not predicted yet over this period.
  };

  void predict_pose(const Control& control);
  /// Puts an object where it is observed, whatever was known of it.
  void place(Object& object, const Eigen::Vector2d& range_bearing);
  void predict_unobserved(Object& object);
  void update_with_modes(Object& object, const Eigen::Vector2d& range_bearing);

  Eigen::VectorXd mean_;
  Eigen::MatrixXd P_;
  std::vector<Object> objects_;
};

/// Place of an observed object, and its derivatives by pose and observation.
struct ObservedPlace {
  Eigen::Vector2d place_m;
  Eigen::Matrix<double, 2, 3> by_pose;
  Eigen::Matrix2d by_observation;
};
ObservedPlace observed_place(const geometry::Pose2& world_from_base,
                             const Eigen::Vector2d& range_bearing);

/// Of range and bearing.
Eigen::Matrix2d observation_covariance();

}  // namespace slammot::joint_posterior
