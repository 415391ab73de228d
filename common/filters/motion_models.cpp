#include "common/filters/motion_models.hpp"

#include <algorithm>
#include <cmath>

#include "common/filters/kalman.hpp"

namespace slammot::filters {
namespace {

using Vector2 = Eigen::Vector2d;
using Matrix2 = Eigen::Matrix2d;

constexpr double kSlowestTurnerMps = 0.5;  ///< Below it the direction of travel, and so the turn, is not known.
constexpr double kFastestTurnRadps = 2.0;

double turn_rate_radps(const Vector6& state) {
  const Vector2 velocity = state.segment<2>(2);
  const Vector2 acceleration = state.segment<2>(4);
  const double speed = std::max(velocity.norm(), kSlowestTurnerMps);
  const double rate = (velocity.x() * acceleration.y() - velocity.y() * acceleration.x()) / (speed * speed);
  return std::clamp(rate, -kFastestTurnRadps, kFastestTurnRadps);
}

Matrix2 rotation(double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return Matrix2{{c, -s}, {s, c}};
}

Matrix6 turn_jacobian(const Vector6& state, double time_s) {
  constexpr double kStep = 1e-5;
  Matrix6 jacobian;
  for (int column = 0; column < 6; ++column) {
    const Vector6 step = kStep * Vector6::Unit(column);
    jacobian.col(column) = (turned(state + step, time_s) - turned(state - step, time_s)) / (2.0 * kStep);
  }
  return jacobian;
}

}  // namespace

Matrix6 constant_velocity_transition(double time_s) {
  Matrix6 F = Matrix6::Zero();
  F.topLeftCorner<4, 4>().setIdentity();
  F(0, 2) = F(1, 3) = time_s;
  return F;
}

Matrix6 constant_velocity_noise(double time_s, double noise_density, double idle_acceleration_mps2) {
  const double t = time_s;
  Matrix6 Q = Matrix6::Zero();
  for (int axis = 0; axis < 2; ++axis) {
    Q(axis, axis) = noise_density * t * t * t / 3.0;
    Q(axis, axis + 2) = Q(axis + 2, axis) = noise_density * t * t / 2.0;
    Q(axis + 2, axis + 2) = noise_density * t;
    Q(axis + 4, axis + 4) = idle_acceleration_mps2 * idle_acceleration_mps2;
  }
  return Q;
}

Matrix6 constant_acceleration_transition(double time_s) {
  Matrix6 F = Matrix6::Identity();
  F(0, 2) = F(1, 3) = F(2, 4) = F(3, 5) = time_s;
  F(0, 4) = F(1, 5) = 0.5 * time_s * time_s;
  return F;
}

Matrix6 constant_acceleration_noise(double time_s, double noise_density) {
  const double t = time_s;
  Eigen::Matrix3d q;
  q << t * t * t * t * t / 20.0, t * t * t * t / 8.0, t * t * t / 6.0,  //
      t * t * t * t / 8.0, t * t * t / 3.0, t * t / 2.0,                //
      t * t * t / 6.0, t * t / 2.0, t;
  Matrix6 Q = Matrix6::Zero();
  for (int axis = 0; axis < 2; ++axis)
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) Q(axis + 2 * row, axis + 2 * column) = noise_density * q(row, column);
  return Q;
}

Vector6 turned(const Vector6& state, double time_s) {
  const Vector2 velocity = state.segment<2>(2);
  const double angle = turn_rate_radps(state) * time_s;
  // Integral of the turning velocity over time_s: chord of the arc, exact for every angle, without dividing by it.
  const double half = 0.5 * angle;
  const double chord = std::abs(half) < 1e-4 ? 1.0 - half * half / 6.0 : std::sin(half) / half;
  const Matrix2 turn = rotation(angle);
  Vector6 after;
  after.head<2>() = state.head<2>() + time_s * chord * (rotation(half) * velocity);
  after.segment<2>(2) = turn * velocity;
  after.segment<2>(4) = turn * state.segment<2>(4);
  return after;
}

MotionState predict(const MotionModel& model, const MotionState& state, double time_s) {
  switch (model.kind) {
    case MotionKind::kConstantVelocity:
      return kalman_predict<6>(state, constant_velocity_transition(time_s),
                               constant_velocity_noise(time_s, model.noise_density, model.idle_acceleration_mps2));
    case MotionKind::kConstantAcceleration:
      return kalman_predict<6>(state, constant_acceleration_transition(time_s),
                               constant_acceleration_noise(time_s, model.noise_density));
    case MotionKind::kCoordinatedTurn: break;
  }
  const Matrix6 F = turn_jacobian(state.mean, time_s);
  return {turned(state.mean, time_s),
          F * state.covariance * F.transpose() + constant_acceleration_noise(time_s, model.noise_density)};
}

}  // namespace slammot::filters
