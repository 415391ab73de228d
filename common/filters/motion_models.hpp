#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "common/filters/gaussian.hpp"

namespace slammot::filters {

/// One state for all motion models, so that they can be mixed: (x, y [m], vx, vy [m/s], ax, ay [m/s^2]), in a frame
/// that does not move.
using MotionState = Gaussian<6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

enum class MotionKind : std::uint8_t { kConstantVelocity, kConstantAcceleration, kCoordinatedTurn };

struct MotionModel {
  MotionKind kind = MotionKind::kConstantVelocity;
  /// Power spectral density of the white noise that drives the highest derivative: of acceleration for constant
  /// velocity [m^2/s^3], of jerk for the others [m^2/s^5]. A density, unlike the thesis' noise per sampling period
  /// (Eqs. 4.7, 4.12), means the same at every scan rate.
  double noise_density = 1.0;
  /// One sigma of the acceleration that the constant-velocity model leaves open, m/s^2: what a mixture hands to the
  /// models that know an acceleration. Zero would make it claim that there is exactly none.
  double idle_acceleration_mps2 = 1.0;
};

/// Where the object is after time_s (>= 0) if it moves as this model says.
/// Constant velocity and acceleration: Wang 2004, Section 4.3, with continuous-time noise. Coordinated turn: the
/// acceleration across the direction of travel turns with it; linearized at the mean.
MotionState predict(const MotionModel& model, const MotionState& state, double time_s);

/// Transition and process noise of constant velocity on the shared state; acceleration is forgotten.
Matrix6 constant_velocity_transition(double time_s);
Matrix6 constant_velocity_noise(double time_s, double noise_density, double idle_acceleration_mps2);

/// Transition and process noise of constant acceleration.
Matrix6 constant_acceleration_transition(double time_s);
Matrix6 constant_acceleration_noise(double time_s, double noise_density);

/// Mean of a coordinated turn after time_s: speed and turn rate, as position, velocity and acceleration imply them, stay.
Vector6 turned(const Vector6& state, double time_s);

}  // namespace slammot::filters
