#include "common/filters/motion_models.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::filters {
namespace {

using Vector2 = Eigen::Vector2d;
using Matrix2 = Eigen::Matrix2d;

constexpr double kSlowestTurnerMps = 0.5;  ///< Below it the direction of travel, and therefore the
                                           ///< turn, is undefined.
constexpr double kFastestTurnRadps = 2.0;

struct TurnRate {
  double radps = 0.0;
  Vector2 by_velocity = Vector2::Zero();  ///< Its derivatives by the velocity; zero where the rate
                                          ///< is clamped.
  Vector2 by_acceleration = Vector2::Zero();
};

TurnRate turn_rate(const Vector6& state) {
  const Vector2 velocity = state.segment<2>(2);
  const Vector2 acceleration = state.segment<2>(4);
  const double speed2 = std::max(velocity.squaredNorm(), kSlowestTurnerMps * kSlowestTurnerMps);
  const double rate = (velocity.x() * acceleration.y() - velocity.y() * acceleration.x()) / speed2;
  if (std::abs(rate) > kFastestTurnRadps) return {std::copysign(kFastestTurnRadps, rate)};
  Vector2 by_velocity = Vector2(acceleration.y(), -acceleration.x()) / speed2;
  if (velocity.squaredNorm() > kSlowestTurnerMps * kSlowestTurnerMps)
    by_velocity -= 2.0 * rate / speed2 * velocity;
  return {rate, by_velocity, Vector2(-velocity.y(), velocity.x()) / speed2};
}

Matrix2 rotation(double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return Matrix2{{c, -s}, {s, c}};
}

Vector2 quarter_turned(const Vector2& vector) { return {-vector.y(), vector.x()}; }

/// Mean direction during a turn by twice `half`, relative to the direction in the middle: chord
/// over arc.
double chord_over_arc(double half) {
  return std::abs(half) < 1e-4 ? 1.0 - half * half / 6.0 : std::sin(half) / half;
}

double chord_over_arc_derivative(double half) {
  return std::abs(half) < 1e-3 ? -half / 3.0 : (std::cos(half) - chord_over_arc(half)) / half;
}

/// Terms of a turn over a time step: for its end state and its derivatives.
struct Turn {
  TurnRate rate;
  Matrix2 half;   ///< Rotation by half of the turn
  Matrix2 whole;  ///< and by the whole turn.
  double chord = 1.0;
  double chord_derivative = 0.0;
};

Turn turn_of(const Vector6& state, double time_s) {
  const TurnRate rate = turn_rate(state);
  const double half_rad = 0.5 * rate.radps * time_s;
  const Matrix2 half = rotation(half_rad);
  return {rate, half, half * half, chord_over_arc(half_rad), chord_over_arc_derivative(half_rad)};
}

/// Integral of the turning velocity: exact for every angle, without division by the angle.
Vector6 end_of(const Turn& turn, const Vector6& state, double time_s) {
  Vector6 after;
  after.head<2>() = state.head<2>() + time_s * turn.chord * (turn.half * state.segment<2>(2));
  after.segment<2>(2) = turn.whole * state.segment<2>(2);
  after.segment<2>(4) = turn.whole * state.segment<2>(4);
  return after;
}

/// Derivative of the end state by the start state: that of a fixed turn rate plus the effect of a
/// change of the rate.
Matrix6 jacobian_of(const Turn& turn, const Vector6& state, double time_s) {
  const Vector2 half_way = turn.half * state.segment<2>(2);
  Vector6 by_rate;
  by_rate.head<2>() = 0.5 * time_s * time_s *
                      (turn.chord_derivative * half_way + turn.chord * quarter_turned(half_way));
  by_rate.segment<2>(2) = time_s * quarter_turned(turn.whole * state.segment<2>(2));
  by_rate.segment<2>(4) = time_s * quarter_turned(turn.whole * state.segment<2>(4));
  Matrix6 jacobian = Matrix6::Identity();
  jacobian.block<2, 2>(0, 2) = time_s * turn.chord * turn.half;
  jacobian.block<2, 2>(2, 2) = jacobian.block<2, 2>(4, 4) = turn.whole;
  jacobian.middleCols<2>(2) += by_rate * turn.rate.by_velocity.transpose();
  jacobian.middleCols<2>(4) += by_rate * turn.rate.by_acceleration.transpose();
  return jacobian;
}

/// Process noise of one axis: (position, velocity, acceleration).
Eigen::Matrix3d axis_noise_of_constant_velocity(double t, double noise_density,
                                                double idle_acceleration_mps2) {
  Eigen::Matrix3d q;
  q << noise_density * t * t * t / 3.0, noise_density * t * t / 2.0, 0.0,  //
      noise_density * t * t / 2.0, noise_density * t, 0.0,                 //
      0.0, 0.0, idle_acceleration_mps2 * idle_acceleration_mps2;
  return q;
}

Eigen::Matrix3d axis_noise_of_constant_acceleration(double t, double noise_density) {
  Eigen::Matrix3d q;
  q << t * t * t * t * t / 20.0, t * t * t * t / 8.0, t * t * t / 6.0,  //
      t * t * t * t / 8.0, t * t * t / 3.0, t * t / 2.0,                //
      t * t * t / 6.0, t * t / 2.0, t;
  return noise_density * q;
}

/// Adds the same process noise in both axes to P.
Matrix6 with_noise(const Matrix6& P, const Eigen::Matrix3d& of_axis) {
  Matrix6 noisy = P;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      noisy.block<2, 2>(2 * row, 2 * column).diagonal().array() += of_axis(row, column);
  return noisy;
}

/// F m of constant acceleration.
Vector6 accelerated(const Vector6& mean, double time_s) {
  Vector6 after = mean;
  after.head<2>() += time_s * mean.segment<2>(2) + 0.5 * time_s * time_s * mean.segment<2>(4);
  after.segment<2>(2) += time_s * mean.segment<2>(4);
  return after;
}

/// F P F' of constant acceleration, without the zeros of F (imm_path in filters_bench.cpp).
Matrix6 spread_by_constant_acceleration(const Matrix6& P, double time_s) {
  const double half_t2 = 0.5 * time_s * time_s;
  Matrix6 spread = P;
  spread.topRows<2>() += time_s * spread.middleRows<2>(2) + half_t2 * spread.bottomRows<2>();
  spread.middleRows<2>(2) += time_s * spread.bottomRows<2>();
  spread.leftCols<2>() += time_s * spread.middleCols<2>(2) + half_t2 * spread.rightCols<2>();
  spread.middleCols<2>(2) += time_s * spread.rightCols<2>();
  return spread;
}

/// F m of constant velocity.
Vector6 coasted(const Vector6& mean, double time_s) {
  Vector6 after = mean;
  after.head<2>() += time_s * mean.segment<2>(2);
  after.tail<2>().setZero();
  return after;
}

/// F P F' of constant velocity.
Matrix6 spread_by_constant_velocity(const Matrix6& P, double time_s) {
  Matrix6 spread = P;
  spread.topRows<2>() += time_s * spread.middleRows<2>(2);
  spread.leftCols<2>() += time_s * spread.middleCols<2>(2);
  spread.bottomRows<2>().setZero();
  spread.rightCols<2>().setZero();
  return spread;
}

/// Wang 2004, Eqs. (4.14)-(4.16); the velocity is that of the step, the acceleration idle.
MotionState stopped(const MotionModel& model, const MotionState& state, double time_s) {
  MotionState next;
  next.mean.head<2>() = state.mean.head<2>();
  const Matrix2 velocity = model.noise_density * Matrix2::Identity();
  next.covariance.topLeftCorner<2, 2>() =
      state.covariance.topLeftCorner<2, 2>() + time_s * time_s * velocity;
  next.covariance.block<2, 2>(0, 2) = next.covariance.block<2, 2>(2, 0) = time_s * velocity;
  next.covariance.block<2, 2>(2, 2) = velocity;
  next.covariance.block<2, 2>(4, 4) =
      model.idle_acceleration_mps2 * model.idle_acceleration_mps2 * Matrix2::Identity();
  return next;
}

}  // namespace

Matrix6 constant_velocity_transition(double time_s) {
  Matrix6 F = Matrix6::Zero();
  F.topLeftCorner<4, 4>().setIdentity();
  F(0, 2) = F(1, 3) = time_s;
  return F;
}

Matrix6 constant_velocity_noise(double time_s, double noise_density,
                                double idle_acceleration_mps2) {
  return with_noise(Matrix6::Zero(),
                    axis_noise_of_constant_velocity(time_s, noise_density, idle_acceleration_mps2));
}

Matrix6 constant_acceleration_transition(double time_s) {
  Matrix6 F = Matrix6::Identity();
  F(0, 2) = F(1, 3) = F(2, 4) = F(3, 5) = time_s;
  F(0, 4) = F(1, 5) = 0.5 * time_s * time_s;
  return F;
}

Matrix6 constant_acceleration_noise(double time_s, double noise_density) {
  return with_noise(Matrix6::Zero(), axis_noise_of_constant_acceleration(time_s, noise_density));
}

Vector6 turned(const Vector6& state, double time_s) {
  return end_of(turn_of(state, time_s), state, time_s);
}

MotionState predict(const MotionModel& model, const MotionState& state, double time_s) {
  switch (model.kind) {
    case MotionKind::kConstantVelocity:
      return {coasted(state.mean, time_s),
              with_noise(spread_by_constant_velocity(state.covariance, time_s),
                         axis_noise_of_constant_velocity(time_s, model.noise_density,
                                                         model.idle_acceleration_mps2))};
    case MotionKind::kConstantAcceleration:
      return {accelerated(state.mean, time_s),
              with_noise(spread_by_constant_acceleration(state.covariance, time_s),
                         axis_noise_of_constant_acceleration(time_s, model.noise_density))};
    case MotionKind::kStop: return stopped(model, state, time_s);
    case MotionKind::kCoordinatedTurn: break;
  }
  const Turn turn = turn_of(state.mean, time_s);
  const Matrix6 F = jacobian_of(turn, state.mean, time_s);
  return {end_of(turn, state.mean, time_s),
          with_noise(F * state.covariance * F.transpose(),
                     axis_noise_of_constant_acceleration(time_s, model.noise_density))};
}

}  // namespace slammot::filters
