#include "common/filters/formation.hpp"

#include <cassert>

#include <Eigen/Cholesky>

namespace slammot::filters {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Index at(std::size_t member) { return 6 * static_cast<Index>(member); }

Matrix6 transition_of(const MotionModel& model, double time_s) {
  return model.kind == MotionKind::kConstantVelocity ? constant_velocity_transition(time_s)
                                                     : constant_acceleration_transition(time_s);
}

Matrix6 noise_of(const MotionModel& model, double time_s) {
  return model.kind == MotionKind::kConstantVelocity
             ? constant_velocity_noise(time_s, model.noise_density, model.idle_acceleration_mps2)
             : constant_acceleration_noise(time_s, model.noise_density);
}

}  // namespace

FormationState formation_of(std::span<const MotionState> members) {
  const auto size = at(members.size());
  FormationState state{VectorXd::Zero(size), MatrixXd::Zero(size, size)};
  for (std::size_t i = 0; i < members.size(); ++i) {
    state.mean.segment<6>(at(i)) = members[i].mean;
    state.covariance.block<6, 6>(at(i), at(i)) = members[i].covariance;
  }
  return state;
}

FormationState predict(const FormationMotion& motion, const FormationState& state, double time_s) {
  assert(time_s >= 0.0);
  assert(motion.model.kind == MotionKind::kConstantVelocity ||
         motion.model.kind == MotionKind::kConstantAcceleration);
  const Matrix6 F = transition_of(motion.model, time_s);
  const Matrix6 Q = noise_of(motion.model, time_s);
  FormationState predicted = state;
  for (std::size_t i = 0; i < state.size(); ++i) {
    predicted.mean.segment<6>(at(i)) = F * state.mean.segment<6>(at(i));
    for (std::size_t j = 0; j < state.size(); ++j)
      predicted.covariance.block<6, 6>(at(i), at(j)) =
          F * state.covariance.block<6, 6>(at(i), at(j)) * F.transpose() +
          (i == j ? 1.0 : motion.shared_share) * Q;
  }
  return predicted;
}

FormationState update(const FormationState& state, std::span<const MemberFix> fixes,
                      const Eigen::Matrix2d& R_shared) {
  if (fixes.empty()) return state;
  const auto rows = 2 * static_cast<Index>(fixes.size());
  MatrixXd H = MatrixXd::Zero(rows, state.mean.size());
  MatrixXd R = MatrixXd::Zero(rows, rows);
  VectorXd residual(rows);
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    const auto row = 2 * static_cast<Index>(i);
    H.block<2, 2>(row, at(fixes[i].member)).setIdentity();
    residual.segment<2>(row) = fixes[i].position_m - state.mean.segment<2>(at(fixes[i].member));
    for (std::size_t j = 0; j < fixes.size(); ++j)
      R.block<2, 2>(row, 2 * static_cast<Index>(j)) = R_shared;
    R.block<2, 2>(row, row) += fixes[i].R;
  }
  const MatrixXd PHt = state.covariance * H.transpose();
  const MatrixXd S = H * PHt + R;
  const MatrixXd K = S.llt().solve(PHt.transpose()).transpose();
  const MatrixXd I_KH = MatrixXd::Identity(state.mean.size(), state.mean.size()) - K * H;
  return {state.mean + K * residual,
          I_KH * state.covariance * I_KH.transpose() + K * R * K.transpose()};
}

MotionState member_of(const FormationState& state, std::size_t member) {
  return {state.mean.segment<6>(at(member)), state.covariance.block<6, 6>(at(member), at(member))};
}

void formation_shift(FormationState& state, std::size_t member, const Eigen::Vector2d& by_m) {
  state.mean.segment<2>(at(member)) += by_m;
}

}  // namespace slammot::filters
