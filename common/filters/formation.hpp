#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Core>

#include "common/filters/motion_models.hpp"

namespace slammot::filters {

/// Objects that move together as one system: their states augmented to one, with the covariances between them (Wang 2004,
/// Section 4.7; Rogers 1988). The places differ; what drives them is much the same, so that whoever is seen tells of those
/// who are not. Members are in order, each with the six numbers of a MotionState.
struct FormationState {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;

  std::size_t size() const { return static_cast<std::size_t>(mean.size()) / 6; }
};

struct FormationMotion {
  MotionModel model;         ///< Of each member: constant velocity or constant acceleration.
  double shared_share = 0.0;  ///< Of what drives them, so much drives all alike: 0 for strangers, 1 for what is rigid.
};

/// A measured position of one member.
struct MemberFix {
  std::size_t member = 0;
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d R = Eigen::Matrix2d::Identity();  ///< Of its own error, positive definite.
};

/// Members whose errors have nothing in common yet.
FormationState formation_of(std::span<const MotionState> members);

/// All over time_s >= 0: x' = (I * F) x, with noise ((1 - s) I + s 1 1') * Q for the shared share s (* is Kronecker's).
FormationState predict(const FormationMotion& motion, const FormationState& state, double time_s);

/// Corrects all by the members that were seen, each at most once. R_shared: covariance of the error that all fixes of a scan
/// have in common, as that of the vehicle's pose is; may be zero.
FormationState update(const FormationState& state, std::span<const MemberFix> fixes, const Eigen::Matrix2d& R_shared);

/// What is known of one member: its part of the system's state.
MotionState member_of(const FormationState& state, std::size_t member);

/// Moves one member's place by a known amount: the same object seen from another reference point.
void formation_shift(FormationState& state, std::size_t member, const Eigen::Vector2d& by_m);

}  // namespace slammot::filters
