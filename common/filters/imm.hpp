#pragma once

#include <array>
#include <span>

#include <Eigen/Core>

#include "common/filters/gaussian.hpp"
#include "common/filters/model_set.hpp"

namespace slammot::filters {

/// One estimate for each model and how probable each is.
struct ImmState {
  std::array<MotionState, kMaxModels> modes;
  ModelWeights probability = {};
};

struct ImmUpdate {
  ImmState posterior;
  double log_likelihood = 0.0;  ///< Of the measurement under the mixture.
};

/// Every model starts from the same estimate, all models equally probable.
ImmState imm_start(const ModelSet& set, const MotionState& estimate);

/// Mixing (Wang 2004, Eqs. 2.49-2.51) and mode-matched prediction over time_s >= 0. The probability of a switch
/// follows from the time and the mean stay, not from the number of scans. The set may be another than in the step before, as
/// long as one is the beginning of the other (variable structure: Li and Bar-Shalom 1996): a model that is new gets its share
/// by switches, and the last model that is left takes over from those that are gone.
ImmState imm_predict(const ModelSet& set, const ImmState& state, double time_s);

/// What a measured position (covariance R, positive definite) says about the combined prediction.
Innovation<2> imm_innovation(const ModelSet& set, const ImmState& predicted, const Eigen::Vector2d& position_m, const Eigen::Matrix2d& R);

/// Mode-matched update with a measured position (covariance R, positive definite) and the models' probabilities;
/// Wang 2004, Eqs. (2.46)-(2.47).
ImmUpdate imm_update(const ModelSet& set, const ImmState& predicted, const Eigen::Vector2d& position_m,
                     const Eigen::Matrix2d& R);

/// Mode-matched update with a measured component of the velocity: direction (unit length) times velocity is speed_mps, with
/// variance > 0 in (m/s)^2. The models' probabilities stay: such a measurement tells where to, not how it manoeuvres.
ImmState imm_update_speed(const ModelSet& set, const ImmState& predicted, const Eigen::Vector2d& direction, double speed_mps,
                          double variance);

/// Moment-matched mean and covariance of the mixture; Wang 2004, Eqs. (2.52)-(2.53).
MotionState imm_combine(const ModelSet& set, const ImmState& state);

/// Fills the path with mean and covariance of the mixture's position after step_s, 2 step_s, ..., if nothing is measured: each step mixes and
/// predicts as imm_predict does, so that what manoeuvres now may go on to, or cease.
void imm_foretell(const ModelSet& set, const ImmState& state, double step_s, std::span<Gaussian<2>> path);

/// Moves every mode's position by the same known amount: the same object seen from another reference point.
void imm_shift(const ModelSet& set, ImmState& state, const Eigen::Vector2d& shift_m);

/// The same by an amount that is known no better than this covariance: positions from now on are of another reference point,
/// and the step from the one to the other is no motion.
void imm_loosen(const ModelSet& set, ImmState& state, const Eigen::Matrix2d& covariance_m2);

}  // namespace slammot::filters
