#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <Eigen/Core>

#include "common/filters/kalman.hpp"
#include "common/filters/motion_models.hpp"

namespace slammot::filters {

inline constexpr std::size_t kMaxModels = 3;

/// The set of motions among which an object is believed to switch.
struct ModelSet {
  std::array<MotionModel, kMaxModels> models;
  std::size_t size = 0;              ///< Models in use, from the front; at least 1.
  double mean_stay_s = 1.0;          ///< Mean time for which an object keeps to one model before it switches, > 0.
};

using ModelWeights = std::array<double, kMaxModels>;

/// All models equally probable.
ModelWeights equal_weights(const ModelSet& set);

/// Probability to be in model `to` after time_s when now in `from`; Wang 2004, Eq. (2.45), but for a time, not a scan.
double switch_probability(const ModelSet& set, std::size_t from, std::size_t to, double time_s);

/// Mean and covariance of a mixture of Gaussians; Wang 2004, Eqs. (2.52)-(2.53). As many weights as modes, of sum 1.
MotionState moment_match(std::span<const MotionState> modes, std::span<const double> weight);

/// The same of position and velocity; the acceleration is left at zero.
MotionState moment_match_moving(std::span<const MotionState> modes, std::span<const double> weight);

/// The same of the position alone.
Gaussian<2> moment_match_position(std::span<const MotionState> modes, std::span<const double> weight);

/// Makes probabilities of sum 1 of logarithms of weights; returns the logarithm of what their sum was.
double normalize_logs(std::span<double> log_weight);

/// Conditions a state on a measured position (covariance R, positive definite).
KalmanUpdate<6, 2> update_with_position(const MotionState& predicted, const Eigen::Vector2d& position_m, const Eigen::Matrix2d& R);

}  // namespace slammot::filters
