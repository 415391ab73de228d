#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "common/filters/gaussian.hpp"

namespace slammot::filters {

/// Common state of all motion models, so that they can be mixed: (x, y [m], vx, vy [m/s], ax, ay
/// [m/s^2]) in a fixed frame.
using MotionState = Gaussian<6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

enum class MotionKind : std::uint8_t {
  kConstantVelocity,
  kConstantAcceleration,
  kCoordinatedTurn,
  /// The stop model simplified from constant velocity (Wang 2004, Eqs. 4.13-4.16), which degrades a
  /// mixture (Section 4.5). For comparison; tracking stops by filters::MoveStop.
  kStop
};

struct MotionModel {
  MotionKind kind = MotionKind::kConstantVelocity;
  /// Power spectral density of the white noise on the highest derivative: of acceleration for
  /// constant velocity [m^2/s^3], of jerk for the others [m^2/s^5]. A density is independent of the
  /// scan rate, unlike the thesis' noise per sampling period (Eqs. 4.7, 4.12). Of the stop model:
  /// the variance of the velocity, drawn anew at each step [m^2/s^2].
  double noise_density = 1.0;
  /// One sigma of the acceleration [m/s^2] that the constant-velocity model does not estimate. A
  /// mixture passes it to models with an acceleration. Zero would claim an acceleration of exactly
  /// zero.
  double idle_acceleration_mps2 = 1.0;
};

/// Prediction over time_s (>= 0) under this model. Constant velocity and acceleration: Wang 2004,
/// Section 4.3, with continuous-time noise. Coordinated turn: the acceleration across the direction
/// of travel turns with that direction; linearized at the mean.
MotionState predict(const MotionModel& model, const MotionState& state, double time_s);

/// Transition and process noise of constant velocity on the common state; the acceleration is
/// reset.
Matrix6 constant_velocity_transition(double time_s);
Matrix6 constant_velocity_noise(double time_s, double noise_density, double idle_acceleration_mps2);

/// Transition and process noise of constant acceleration.
Matrix6 constant_acceleration_transition(double time_s);
Matrix6 constant_acceleration_noise(double time_s, double noise_density);

/// Mean of a coordinated turn after time_s. Speed and turn rate are constant, as implied by
/// position, velocity and acceleration.
Vector6 turned(const Vector6& state, double time_s);

}  // namespace slammot::filters
