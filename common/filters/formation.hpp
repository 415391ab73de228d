#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Core>

#include "common/filters/motion_models.hpp"

namespace slammot::filters {

/// Objects that move together as one augmented state with cross-covariances (Wang 2004,
/// Section 4.7; Rogers 1988). Positions differ but process noise is mostly shared, so that a
/// measurement of one member corrects the others. Members are in order; each has the six entries of
/// a MotionState.
struct FormationState {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;

  std::size_t size() const { return static_cast<std::size_t>(mean.size()) / 6; }
};

struct FormationMotion {
  MotionModel model;          ///< Of each member: constant velocity or constant acceleration.
  double shared_share = 0.0;  ///< Share of the process noise that is common to all members: 0
                              ///< independent, 1 rigid.
};

/// A measured position of one member.
struct MemberFix {
  std::size_t member = 0;
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d R = Eigen::Matrix2d::Identity();  ///< Covariance of the independent error [m^2],
                                                    ///< positive definite.
};

/// Joint state of members with independent errors.
FormationState formation_of(std::span<const MotionState> members);

/// Predicts all members over time_s >= 0: x' = (I ⊗ F) x with noise ((1 - s) I + s 1 1') ⊗ Q for
/// the shared share s (⊗: Kronecker product).
FormationState predict(const FormationMotion& motion, const FormationState& state, double time_s);

/// Updates all members with the measured ones, each at most once. R_shared: covariance of the error
/// that is common to all fixes of a scan, such as that of the vehicle's pose; may be zero.
FormationState update(const FormationState& state, std::span<const MemberFix> fixes,
                      const Eigen::Matrix2d& R_shared);

/// Marginal of one member.
MotionState member_of(const FormationState& state, std::size_t member);

/// Shifts one member's position by a known offset: a change of its reference point.
void formation_shift(FormationState& state, std::size_t member, const Eigen::Vector2d& by_m);

}  // namespace slammot::filters
