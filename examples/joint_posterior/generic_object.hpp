#pragma once

#include <array>

#include <Eigen/Core>

namespace slammot::joint_posterior {

/// Motion modes of a generic object (Wang 2004, Section 2.4): state (x, y [m], vx, vy [m/s]).
inline constexpr std::size_t kModes = 2;
enum Mode : std::size_t { kStationary, kMoving };

using ObjectState = Eigen::Vector4d;
using ObjectCovariance = Eigen::Matrix4d;
using ModeWeights = std::array<double, kModes>;
inline constexpr ModeWeights kUnknownMode{0.5, 0.5};

/// Linear motion of one mode over a period, with its noise.
struct ModeModel {
  Eigen::Matrix4d F;
  Eigen::Matrix4d Q;
};
const ModeModel& model_of(Mode mode);

/// Probabilities after a period without a measurement.
ModeWeights switched(const ModeWeights& weights);

/// Gaussian of an object's state.
struct ObjectEstimate {
  ObjectState mean = ObjectState::Zero();
  ObjectCovariance covariance = ObjectCovariance::Zero();
};

/// Estimate of a new object at a place that is measured with this covariance; its velocity is
/// unknown.
ObjectEstimate begin_at(const Eigen::Vector2d& place_m, const Eigen::Matrix2d& covariance_m2);

/// An object of its own: filters of both modes from one estimate, merged at each measurement
/// (GPB1, Wang 2004, Section 2.3).
struct HybridTrack {
  ObjectEstimate estimate;
  ModeWeights weights = kUnknownMode;
  std::array<ObjectEstimate, kModes> predicted;

  void predict();
  /// Measured place with its covariance, which includes the pose's.
  void update(const Eigen::Vector2d& place_m, const Eigen::Matrix2d& covariance_m2);
  /// Merges the predictions without a measurement.
  void miss();
};

/// Moment-matched mixture.
ObjectEstimate merged(const std::array<ObjectEstimate, kModes>& modes, const ModeWeights& weights);

}  // namespace slammot::joint_posterior
