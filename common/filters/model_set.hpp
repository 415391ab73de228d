#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "common/filters/kalman.hpp"
#include "common/filters/motion_models.hpp"

namespace slammot::filters {

inline constexpr std::size_t kMaxModels = 3;

/// Which histories of modes are merged, and when (Wang 2004, Section 2.3): what every model starts
/// its prediction from. r models.
enum class Mixture : std::uint8_t {
  kImm = 0,   ///< The mixed estimate of each model: r filters (Eqs. 2.48-2.51).
  kGpb1 = 1,  ///< One estimate for all models: r filters (Eq. 2.41; Tugnait 1982).
  kGpb2 = 2,  ///< Every model's estimate, merged after the update: r^2 filters (Eq. 2.42).
};

/// Set of motion models between which an object is assumed to switch.
struct ModelSet {
  std::array<MotionModel, kMaxModels> models;
  std::size_t size = 0;      ///< Number of models in use, from the front; at least 1.
  double mean_stay_s = 1.0;  ///< Mean time in one model before a switch, > 0.
  Mixture mixture = Mixture::kImm;
};

using ModelWeights = std::array<double, kMaxModels>;

/// All models equally probable.
ModelWeights equal_weights(const ModelSet& set);

/// Probability of model `to` after time_s, given `from` now; Wang 2004, Eq. (2.45), with time in
/// place of scans.
double switch_probability(const ModelSet& set, std::size_t from, std::size_t to, double time_s);

/// Mean and covariance of a Gaussian mixture; Wang 2004, Eqs. (2.52)-(2.53). One weight a mode;
/// weights sum to 1.
MotionState moment_match(std::span<const MotionState> modes, std::span<const double> weight);

/// The same for position and velocity; the acceleration is zero.
MotionState moment_match_moving(std::span<const MotionState> modes, std::span<const double> weight);

/// The same for the position only.
Gaussian<2> moment_match_position(std::span<const MotionState> modes,
                                  std::span<const double> weight);

/// Logarithm of a probability that may be zero: -690 at least.
double log_of(double probability);

/// Converts log-weights to probabilities of sum 1; returns the logarithm of the weights' sum.
double normalize_logs(std::span<double> log_weight);

/// Kalman update with a measured position (covariance R, positive definite).
KalmanUpdate<6, 2> update_with_position(const MotionState& predicted,
                                        const Eigen::Vector2d& position_m,
                                        const Eigen::Matrix2d& R);

}  // namespace slammot::filters
